#!/bin/sh
# install_packages.sh LIST: installs the Debian packages of LIST that are missing, as root or
# through sudo. Does nothing, quickly, where nothing is missing or where there is no apt-get.
set -eu
command -v dpkg-query >/dev/null 2>&1 || { echo "not Debian: see vcpkg.json"; exit 0; }

missing=""
for package in $(sed -e 's/#.*//' "$1"); do
  status=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
  [ "$status" = installed ] || missing="$missing $package"
done
[ -n "$missing" ] || exit 0

echo "installing:$missing"
run=""
if [ "$(id -u)" != 0 ]; then
  command -v sudo >/dev/null 2>&1 || { echo "need root or sudo to install:$missing" >&2; exit 1; }
  run="sudo"
fi
$run apt-get update -qq
$run env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $missing >/dev/null
