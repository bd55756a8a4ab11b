#!/bin/sh
# Grades a class: ./grade.sh FOLDER [options of `lietool exercise check`, as --jobs 2]
#
# FOLDER holds what was handed in: files that end in .py, in folders of their own if you like. Their first
# lines say which exercise they are for. Marks go to grades.csv, a page for each file to report/index.html.
# A run that was stopped goes on where it was. Ends with 0 when all are graded, whatever their marks.
set -eu

if [ $# -lt 1 ] || [ ! -d "$1" ]; then
    echo "usage: $0 FOLDER [options]: FOLDER holds what was handed in" >&2
    exit 2
fi
folder=$1
shift
here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
if [ -d "$here/project" ]; then
    LIETOOL_PROJECT=$here/project
    export LIETOOL_PROJECT
fi
if [ -z "$(find "$folder" -name '*.py' -type f ! -path '*/__*' ! -path '*/.?*/*' | head -n 1)" ]; then
    echo "$0: no file in $folder ends in .py" >&2
    exit 2
fi
# All files go to one command, for they make one table; it ends with 5 where not all is right.
# shellcheck disable=SC2016
exec find "$folder" -name '*.py' -type f ! -path '*/__*' ! -path '*/.?*/*' \
    -exec sh -c 'lietool exercise check "$@" || [ $? -eq 5 ]' sh \
    --seed @seed@ --csv grades.csv --report report "$@" {} +
