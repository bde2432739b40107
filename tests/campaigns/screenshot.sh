#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# screenshot.sh PICTURE.png COMMAND ...: starts a program that shows a body, on a display of its own, and takes a
# picture of the display once the body is there. Fails where there is none after two minutes, or where the program
# reports an error. Needs Xvfb and ffmpeg.
set -euo pipefail

picture=${1:?usage: screenshot.sh PICTURE.png COMMAND ...}
shift
said=$(mktemp)
exec {ready}< <(exec Xvfb -displayfd 1 -noreset -screen 0 1280x1024x24 -nolisten tcp 2>/dev/null)
server=$!
trap 'kill "${program:-}" 2>/dev/null || true; kill "$server" 2>/dev/null || true; rm -f "$said"' EXIT
trap 'exit 143' TERM INT
read -r -t 30 -u "$ready" number || { echo "screenshot.sh: Xvfb gives no display" >&2; exit 1; }
export DISPLAY=":$number"
# At its first start ParaView shows a dialog, and waits until it is closed.
version=$(paraview --version 2>/dev/null | grep -o '[0-9][0-9.]*$')
mkdir -p "$HOME/.config/ParaView"
printf '[General]\nGeneralSettings.ShowWelcomeDialog=false\n' > "$HOME/.config/ParaView/ParaView$version.ini"
"$@" >"$said" 2>&1 &
program=$!

# Hues in the middle of the display, of bright and saturated colors: icons, text and dialogs are gray for the greater
# part, and a body with a scale of colors has many. Prints how many pixels have one, and how many hues there are.
hues() {
  ffmpeg -loglevel error -i "$picture" -vf 'crop=iw*0.7:ih*0.7,scale=320:-1:flags=neighbor' -f rawvideo -pix_fmt rgb24 - |
    od -An -v -tu1 -w3 | awk '
      {max = $1 > $2 ? $1 : $2; if ($3 > max) max = $3
       min = $1 < $2 ? $1 : $2; if ($3 < min) min = $3
       if (max - min > 70) {pixels++; hue[int($1 / 16) "," int($2 / 16) "," int($3 / 16)]++}}
      END {for (h in hue) if (hue[h] > 1) hues++; print pixels + 0, hues + 0}'
}

fail() {
  head -n 20 "$said" >&2
  echo "screenshot.sh: $*" >&2
  exit 1
}

before=
for _ in $(seq 60); do
  sleep 2
  kill -0 "$program" 2>/dev/null || fail "$1 has ended"
  ffmpeg -loglevel error -y -f x11grab -video_size 1280x1024 -i "$DISPLAY" -frames:v 1 "$picture"
  ! grep -qE 'ERR\||WARN\||critical:|Traceback' "$said" || fail "$1 reports errors"
  seen=$(hues)
  read -r pixels hues <<< "$seen"
  if [ "$pixels" -ge 1500 ] && [ "$hues" -ge 80 ] && [ "$seen" = "$before" ]; then
    echo "$pixels colored pixels of $hues hues"
    exit 0
  fi
  before=$seen
done
fail "$1 shows no body: $pixels colored pixels of $hues hues"
