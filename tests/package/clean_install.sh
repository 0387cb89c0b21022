#!/usr/bin/env bash
# Installs a package on a clean Debian 12, runs the demo there without a display, and then its window on a virtual screen.
# usage: clean_install.sh PACKAGE.deb FOLDER
# FOLDER gets the demo's report and pictures of the window. The system is made by debootstrap from the mirror that
# this machine's apt uses, with its trusted keys. Needs root. All mounts are in a namespace of their own.
set -euo pipefail

if ((EUID != 0)); then
  printf 'run it as root: it makes a system of its own\n' >&2
  exit 1
fi
if [[ ${1:-} != --inside ]]; then
  exec unshare --mount --propagation private -- "$0" --inside "$@"
fi
package=$(realpath "$2")
mkdir -p "$3"
out=$(realpath "$3")
codename=bookworm
screen=1600x1000x24

say() { printf '%s\n' "$*"; }
die() {
  say "$*" >&2
  exit 1
}

work=$(mktemp -d)
clean=$work/debian
screen_process=''
mounted=()
clean_up() {
  local place
  [[ -z $screen_process ]] || kill "$screen_process" 2>/dev/null || true
  # Nothing of this machine may be below it when it is removed.
  for place in "${mounted[@]}"; do
    umount "$place" || return
  done
  rm -rf --one-file-system "$work"
}
trap clean_up EXIT

# "URI SUITE COMPONENT", one a line: Debian's own packages, as this machine's apt finds them.
debian_sources() {
  # shellcheck disable=SC2016 # apt fills these in
  apt-get indextargets --format '$(REPO_URI) $(RELEASE) $(COMPONENT)' 'Created-By: Packages' 'Origin: Debian' |
    grep -E " $codename(-[a-z]+)? " | sort -u
}

make_clean_debian() {
  local mirror
  mirror=$(debian_sources | awk -v suite="$codename" '$2 == suite { print $1; exit }')
  [[ -n $mirror ]] || die "apt knows no mirror of Debian 12: add one to its sources, then run apt-get update"
  mkdir "$clean"
  chmod 755 "$work"
  debootstrap --variant=minbase "$codename" "$clean" "$mirror" >"$work/log" 2>&1 || {
    tail -5 "$work/log" >&2
    die "debootstrap could not make a clean system"
  }
  debian_sources | sed 's/^/deb /' >"$clean/etc/apt/sources.list"
  apt-config dump | grep -E '^Acquire::https?::Proxy' >"$clean/etc/apt/apt.conf.d/proxy" || true
  printf '#!/bin/sh\nexit 101\n' >"$clean/usr/sbin/policy-rc.d"
  chmod 755 "$clean/usr/sbin/policy-rc.d"
  mkdir -p "$clean/dev/shm"
  mount -t proc proc "$clean/proc"
  mounted+=("$clean/proc")
  mount -t tmpfs tmpfs "$clean/dev/shm"
  mounted+=("$clean/dev/shm")
}

# inside COMMAND...: as root, in the clean system.
inside() {
  env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive HOME=/root chroot "$clean" "$@"
}

# as_user COMMAND...: as somebody who has installed nothing, in a home without a file.
as_user() {
  env -i PATH=/usr/bin:/bin LC_ALL=C.UTF-8 HOME=/home/user XDG_RUNTIME_DIR=/home/user DISPLAY="${shown:-}" \
    /usr/sbin/chroot --userspec=user:user "$clean" /bin/sh -c 'cd ~ && exec "$@"' sh "$@"
}

# shellcheck disable=SC2016 # dpkg-query fills it in
installed_packages() { inside dpkg-query -W -f='${db:Status-Status}\n' | grep -cx installed; }
disk_mib() { du --summarize --one-file-system --block-size=1M --exclude='var/cache/apt/*' "$clean" | cut -f1; }

install_package() {
  local packages size begin
  cp "$package" "$clean/package.deb"
  inside apt-get update -qq
  packages=$(installed_packages)
  size=$(disk_mib)
  begin=$SECONDS
  inside apt-get install -y -qq --no-install-recommends /package.deb >"$work/log" 2>&1 || {
    tail -20 "$work/log" >&2
    die "the package could not be installed"
  }
  say "installed in $((SECONDS - begin)) s: $(($(installed_packages) - packages)) packages, $(($(disk_mib) - size)) MiB on the disk"
  grep -q application/x-elbowroom-session "$clean/usr/share/mime/types" || die "the desktop doesn't know the file types"
  inside useradd --create-home user
}

play_demo() {
  local begin=$SECONDS file
  as_user elbowroom --version
  as_user elbowroom demo --headless --out demo
  for file in session.db report.html report.pdf view.png; do
    [[ -s $clean/home/user/demo/$file ]] || die "the demo wrote no $file"
  done
  cp -r "$clean/home/user/demo" "$out/"
  say "demo without a display: $((SECONDS - begin)) s"
}

# A window of the program on a screen of this machine; the clean system has the package and its dependencies only.
show_window() {
  local number status=0
  exec 3<>"$work/number"
  Xvfb -displayfd 3 -screen 0 "$screen" -ac -noreset >"$work/screen.log" 2>&1 &
  screen_process=$!
  for _ in {1..100}; do
    [[ ! -s $work/number ]] || break
    sleep 0.1
  done
  number=$(<"$work/number")
  [[ -n $number ]] || die "no virtual screen"
  shown=:$number
  mkdir -p "$clean/tmp/.X11-unix"
  mount --bind /tmp/.X11-unix "$clean/tmp/.X11-unix"
  mounted+=("$clean/tmp/.X11-unix")
  as_user elbowroom demo --out window --picture window.png --after 4 --gap 140 >"$work/window.log" 2>&1 &
  local window=$!
  # The trial runs when its session is there; then the picture of the screen.
  for _ in {1..300}; do
    [[ ! -e $clean/home/user/window/session.db ]] || break
    sleep 0.1
  done
  sleep 4
  DISPLAY=$shown xwd -root -silent | xwdtopnm 2>/dev/null | pnmtopng 2>/dev/null >"$out/screen.png"
  wait "$window" || status=$?
  cat "$work/window.log"
  ((status == 0)) || die "the window ended with $status"
  [[ -s $clean/home/user/window.png ]] || die "the window drew no picture"
  cp "$clean/home/user/window.png" "$out/window.png"
  say "the window: its own picture, window.png; the screen, screen.png"
}

make_clean_debian
say "clean Debian 12: $(installed_packages) packages"
install_package
play_demo
show_window
inside apt-get remove -y -qq elbowroom >/dev/null 2>&1
[[ ! -e $clean/usr/lib/elbowroom && ! -e $clean/usr/bin/elbowroom ]] || die "files stay behind when it is removed"
say "all is well; pictures and reports: $out"
