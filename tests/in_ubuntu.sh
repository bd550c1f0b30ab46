#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Run the tests with the Python and the dependencies of an Ubuntu release: those of package.xml, as apt has them.
#   sudo tests/in_ubuntu.sh jammy|noble|resolute [words for pytest]
# Needs debootstrap, pip and 1 GB in /var/tmp, where the release stays for the next run; xacro comes from PyPI.
set -eu
release=$1
shift
here=$(cd "$(dirname "$0")/.." && pwd)
root=/var/tmp/multibot-$release
packages=$(sed -n 's/.*<[a-z]*_depend>\(python3-[a-z-]*\)<.*/\1/p' "$here/package.xml" | paste -sd, -)
if [ ! -e "$root/ready" ]; then
  debootstrap --variant=minbase --components=main,universe \
    --include="python3,$packages,python3-tomli,git" "$release" "$root" http://archive.ubuntu.com/ubuntu
  python3 -m pip install --no-deps --target "$root/usr/lib/python3/dist-packages" xacro
  touch "$root/ready"
fi
mkdir -p "$root/package"
for folder in proc dev package; do
  mountpoint -q "$root/$folder" && umount "$root/$folder"
done
mount -t proc proc "$root/proc"
mount --bind /dev "$root/dev"
mount --bind "$here" "$root/package"
trap 'umount "$root/proc" "$root/dev" "$root/package"' EXIT
[ $# -gt 0 ] || set -- -m "not live and not slow"
chroot "$root" env LANG=C.UTF-8 PYTHONDONTWRITEBYTECODE=1 PYTHONPATH=/package \
  sh -c 'cd /package && exec python3 -m pytest -p no:cacheprovider "$@"' sh "$@"
