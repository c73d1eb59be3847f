#!/usr/bin/env bash
# Packs the data that packages, wheels and archives of the program do not contain: .ci/data.sh FILE.zip [COMMIT]
# `grainbench reference fetch FILE.zip` installs them.
set -euo pipefail
out=$(realpath "${1:?usage: .ci/data.sh FILE.zip [COMMIT]}")
cd "$(dirname "$0")/.."
git archive --format=zip --output="$out" "${2:-HEAD}" cases reference ':(exclude)*.rs' ':(exclude)reference/tests'
