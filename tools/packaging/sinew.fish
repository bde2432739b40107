# SPDX-License-Identifier: GPL-3.0-or-later
# Completion of sinew for fish: commands, options, keys after --set, views, files.
function __sinew_command
    set -l words (commandline -opc)
    test (count $words) -ge 2; and echo $words[2]
end
function __sinew_options
    set -l command (__sinew_command)
    test -n "$command"; and sinew $command --completions 2>/dev/null | string match -v '*='
end
function __sinew_keys
    sinew (__sinew_command) --completions 2>/dev/null | string match '*='
end
set -l commands new run check fill simulate play converge sweep measure render view export info presets
complete -c sinew -f -n "not __fish_seen_subcommand_from $commands" -a "$commands"
complete -c sinew -n "__fish_seen_subcommand_from $commands; and string match -q -- '-*' (commandline -ct)" -f -a '(__sinew_options)'
complete -c sinew -l set -x -a '(__sinew_keys)'
complete -c sinew -l view -x -a 'body surface halves cut particles section strain lines forces bonds binding bones'
complete -c sinew -l look -x -a 'screen paper dark'
complete -c sinew -l unit -x -a 'm dm cm mm um in ft'
complete -c sinew -l packing -x -a 'fcc hcp random conformal'
complete -c sinew -l engine -x -a 'built-in lammps'
complete -c sinew -l to -x -a 'vtu lammps dump xyz csv yade peridigm bgeo gltf'
complete -c sinew -n '__fish_seen_subcommand_from export' -l to -x -a 'calculix volume obj ply stl'
complete -c sinew -n '__fish_seen_subcommand_from fill' -l to -x -a tetrahedra
