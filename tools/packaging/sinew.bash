# SPDX-License-Identifier: GPL-3.0-or-later
# Completion of sinew for bash: commands, options, keys after --set, views, files.
_sinew() {
  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} command=${COMP_WORDS[1]}
  local commands="new run check fill simulate play converge sweep measure render view export info presets"
  COMPREPLY=()
  if [ "$COMP_CWORD" = 1 ]; then
    mapfile -t COMPREPLY < <(compgen -W "$commands --help --version" -- "$word")
    return
  fi
  case $before in
    --set)
      mapfile -t COMPREPLY < <(compgen -W "$(sinew "$command" --completions 2>/dev/null | grep =)" -- "$word")
      compopt -o nospace
      return ;;
    --arrays)
      mapfile -t COMPREPLY < <(compgen -W "F J stretch strain hencky_strain strain_eq stress stress_kirchhoff von_mises energy_density D2min turnover surface_layer inverted pose_error all" -- "$word")
      return ;;
    --view)
      mapfile -t COMPREPLY < <(compgen -W "body surface halves cut particles section strain lines forces bonds binding bones" -- "$word")
      return ;;
    --look) mapfile -t COMPREPLY < <(compgen -W "screen paper dark" -- "$word"); return ;;
    --engine) mapfile -t COMPREPLY < <(compgen -W "built-in lammps" -- "$word"); return ;;
    --packing) mapfile -t COMPREPLY < <(compgen -W "fcc hcp random conformal" -- "$word"); return ;;
    --to)
      local formats="vtu lammps dump xyz csv yade peridigm bgeo gltf"
      [ "$command" = fill ] && formats+=" tetrahedra"
      [ "$command" = export ] && formats+=" calculix volume obj ply stl"
      mapfile -t COMPREPLY < <(compgen -W "$formats" -- "$word")
      return ;;
    --unit) mapfile -t COMPREPLY < <(compgen -W "m dm cm mm um in ft" -- "$word"); return ;;
  esac
  if [[ $word == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$(sinew "$command" --completions 2>/dev/null | grep -v =)" -- "$word")
    return
  fi
  compopt -o filenames
  mapfile -t COMPREPLY < <(compgen -f -- "$word")
}
complete -F _sinew sinew
