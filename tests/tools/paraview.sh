#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# paraview.sh MODULES SCRIPT.py ...: runs a script with pvbatch on a display of its own. MODULES is the
# folder filled by get_paraview_python.sh.
set -euo pipefail

modules=$(realpath -m "${1:?usage: paraview.sh MODULES SCRIPT.py ...}")/usr/lib/python3/dist-packages
shift
if [ ! -d "$modules/paraview" ]; then
  echo "paraview.sh: there is no $modules/paraview; call tests/tools/get_paraview_python.sh first" >&2
  exit 1
fi
export PYTHONPATH="$modules" PYTHONDONTWRITEBYTECODE=1
# Open MPI removes the folder of its sessions when it ends, also from under a program that begins.
OMPI_MCA_orte_tmpdir_base=$(mktemp -d)
export OMPI_MCA_orte_tmpdir_base

# -noreset: by default the server starts over whenever its last client leaves, and pvbatch, which opens
# its display more than once, then finds none. -displayfd: the server itself takes a free number and
# tells it once it is ready, so that two started at once do not meet. Both end with this script.
exec {ready}< <(exec setpriv --pdeathsig TERM Xvfb -displayfd 1 -noreset -screen 0 1600x1200x24 \
  -nolisten tcp 2>/dev/null)
server=$!
# The display has ended before this script does: while it ends, it would remove the socket of the next
# one, which takes its number. Open MPI's daemon may still be removing its folder.
trap 'kill "$server" 2>/dev/null || true; wait "$server" 2>/dev/null || true
  rm -rf "$OMPI_MCA_orte_tmpdir_base" 2>/dev/null || true' EXIT
trap 'exit 143' TERM INT
if ! read -r -t 30 -u "$ready" number; then
  echo "paraview.sh: Xvfb gives no display; install xvfb" >&2
  exit 1
fi
DISPLAY=":$number" setpriv --pdeathsig TERM pvbatch "$@" &
wait $!
