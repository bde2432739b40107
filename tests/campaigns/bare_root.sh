# SPDX-License-Identifier: GPL-3.0-or-later
# bare_root.sh: a bare Debian in a folder of its own, for scripts that source it:
#
#     . bare_root.sh
#     make_bare_root bookworm      # or trixie; $root is the folder
#     in_root COMMAND ...          # as root, with nothing of this machine's environment
#     stage NAME COMMAND ...       # prints the minutes it took; its output is in $logs/NAME.log
#
# Made by debootstrap (minbase), as root, from where this machine's apt has its packages, and removed when the script
# ends. Its mounts are in a namespace of the script, so nothing of this machine is ever below the folder elsewhere.
# TMPDIR chooses where the folder is made; BARE_ROOT=FOLDER keeps it there, and uses it again.
# BARE_ROOT_PACKAGES=FOLDER keeps what is downloaded (build/apt by default).

no_bare_root() {
  echo "no bare root can be made: $*" >&2
  exit 1
}

if [ -z "${BARE_ROOT_MOUNTS:-}" ]; then
  [ "$(id -u)" -eq 0 ] || no_bare_root "this is for root"
  command -v debootstrap >/dev/null || no_bare_root "debootstrap is missing (tools/install_packages.sh ci)"
  unshare --mount true 2>/dev/null || no_bare_root "this machine does not allow mounts"
  BARE_ROOT_MOUNTS=own exec unshare --mount "$BASH" "$0" "$@"
fi

# Below the root, the last one first.
mounted_in_root() { awk -v root="$root/" 'index($5, root) == 1 {print $5}' /proc/self/mountinfo | tac; }

processes_in_root() {
  local link
  for link in /proc/[0-9]*/root; do
    [ "$(readlink "$link" 2>/dev/null)" != "$root" ] || basename "$(dirname "$link")"
  done
}

remove_bare_root() {
  trap '' INT TERM HUP
  local place
  if [ -n "$unfinished" ]; then
    tail -n 40 "$logs/$unfinished.log" >&3
    echo "$(basename "$0"): $unfinished failed; its output is in $logs" >&3
  fi
  # shellcheck disable=SC2046
  kill $(jobs -p) 2>/dev/null || true
  for _ in 1 2 3; do
    # shellcheck disable=SC2046
    kill -KILL $(processes_in_root) 2>/dev/null || break
    sleep 0.2
  done
  mounted_in_root | while read -r place; do umount --lazy "$place" || true; done
  [ -z "${BARE_ROOT:-}" ] || return 0
  if [ -n "$(mounted_in_root)" ]; then
    echo "the bare root $root stays: something is mounted below it" >&2
  else
    rm -rf --one-file-system "$root"
  fi
}

# Waits in a manner that a signal interrupts.
attend() {
  "$@" <&0 &
  wait $!
}

in_root() {
  attend chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 \
    DEBIAN_FRONTEND=noninteractive "$@"
}

exec 3>&2
unfinished=
stage() {
  local began=$SECONDS
  unfinished=$1
  "${@:2}" >"$logs/$1.log" 2>&1
  unfinished=
  took SECONDS-began "$1"
}

took() { awk -v seconds=$(($1)) -v what="$2" 'BEGIN {printf "%6.1f minutes  %s\n", seconds / 60, what}'; }

# Archives of Debian that this machine's apt knows, as lines of sources.list for another release.
sources_of() {
  local release
  release=$(. /etc/os-release && echo "${VERSION_CODENAME:-}")
  apt-get indextargets --format '$(ORIGIN)|$(CODENAME)|$(REPO_URI)|$(COMPONENT)' 'Created-By: Packages' |
    awk -F'|' -v from="$release" -v to="$1" '
      $1 == "Debian" && index($2, from) == 1 {print "deb " $3 " " to substr($2, length(from) + 1) " " $4}' | sort -u
}

make_bare_root() {
  local suite=$1 mirror log
  root=${BARE_ROOT:-$(mktemp -d "${TMPDIR:-/tmp}/bare-root.XXXXXX")}
  mkdir -p "$root" "${BARE_ROOT_PACKAGES:=$(dirname "${BASH_SOURCE[0]}")/../../build/apt}"
  root=$(realpath "$root")
  trap remove_bare_root EXIT
  trap 'exit 129' HUP
  trap 'exit 130' INT
  trap 'exit 143' TERM
  chmod 755 "$root"
  if [ ! -e "$root/etc/bare-root" ]; then
    mirror=$(sources_of "$suite" | awk -v suite="$suite" '$3 == suite {print $2; exit}')
    [ -n "$mirror" ] || no_bare_root "apt knows no archive of Debian"
    log=$root/debootstrap.out
    attend debootstrap --variant=minbase --cache-dir="$(realpath "$BARE_ROOT_PACKAGES")" "$suite" "$root" "$mirror" \
      >"$log" 2>&1 || no_bare_root "debootstrap of $suite from $mirror: $(tail -n 1 "$log")"
    rm "$log"
    sources_of "$suite" > "$root/etc/apt/sources.list"
    echo force-unsafe-io > "$root/etc/dpkg/dpkg.cfg.d/90fast"  # nobody misses it after a crash
    apt-config dump | grep '^Acquire::' > "$root/etc/apt/apt.conf.d/90here"
    touch "$root/etc/bare-root"
  fi
  cp -L /etc/resolv.conf /etc/hosts "$root/etc/" 2>/dev/null || true
  { mount -t proc proc "$root/proc" && mount -t sysfs -o ro sysfs "$root/sys" &&
    mkdir -p "$root/dev/shm" "$root/dev/pts" && mount -t tmpfs tmpfs "$root/dev/shm" &&
    mount -t devpts -o newinstance,ptmxmode=666 devpts "$root/dev/pts" &&
    mount --bind "$BARE_ROOT_PACKAGES" "$root/var/cache/apt/archives"; } 2>/dev/null ||
    no_bare_root "/proc, /sys, /dev/shm and /dev/pts cannot be mounted there"
  in_root apt-get -qq update || no_bare_root "its apt finds no packages"
}
