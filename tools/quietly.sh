#!/usr/bin/env bash
# Runs a command and shows what it printed only if it fails.
# Usage: tools/quietly.sh COMMAND [ARGUMENT...]
set -euo pipefail

log=$(mktemp)
trap 'rm -f "$log"' EXIT

status=0
"$@" >"$log" 2>&1 || status=$?
if ((status != 0)); then
  cat "$log" >&2
  echo "failed with status $status: $*" >&2
fi
exit "$status"
