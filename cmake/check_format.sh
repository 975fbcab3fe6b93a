#!/bin/sh
# check_format.sh: fails, and names the lines, where a tracked file is not as clang-format makes it.
set -eu
cd "$(dirname "$0")/.."
git ls-files '*.h' '*.cpp' | xargs clang-format --dry-run -Werror || {
  echo "not formatted: run make format" >&2
  exit 1
}
