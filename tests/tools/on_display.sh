#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# on_display.sh COMMAND ...: runs a command on an X display of its own.
set -euo pipefail

# Numbered by this process: the first number that is free may be one that another display is just leaving, which
# then removes the socket of this one or still holds the lock. -noreset: by default the server starts over whenever
# its last client leaves, and pvbatch, which opens its display more than once, then finds none. -displayfd: the
# server tells its number once it is ready.
number=
for attempt in 0 1 2 3 4; do
  exec {ready}< <(exec setpriv --pdeathsig TERM Xvfb ":$((100 + ($$ + 7919 * attempt) % 50000))" -displayfd 1 \
    -noreset -screen 0 1600x1200x24 -nolisten tcp 2>/dev/null)
  server=$!
  if read -r -t 30 -u "$ready" number; then break; fi
done
trap 'kill "$server" 2>/dev/null || true; wait "$server" 2>/dev/null || true' EXIT
trap 'exit 143' TERM INT
if [ -z "$number" ]; then
  echo "on_display.sh: Xvfb gives no display; install xvfb" >&2
  exit 1
fi
DISPLAY=":$number" setpriv --pdeathsig TERM "$@" &
wait $!
