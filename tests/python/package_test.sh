#!/usr/bin/env bash
# Builds the package of python/ as its users do and tests it in an environment of its own.
#   package_test.sh TREE BUILD    BUILD has bin/tumble; the environment and what is compiled stay in BUILD/python
set -euo pipefail
tree=$1 build=$2 work=$2/python
environment=$work/environment
mkdir -p "$work"
[ -x "$environment/bin/python" ] || /usr/bin/python3 -m venv "$environment"
"$environment/bin/python" -m pip install --quiet --disable-pip-version-check "$tree/python[test,tables,files]" --config-settings=build-dir="$work/compiled"

# what a wheel may be: itself alone, small, of no shared library but those of every system
"$environment/bin/python" "$tree/tests/python/wheel_check.py" "$environment"

export TUMBLE_ROOT=$tree TUMBLE_PROGRAM=$build/bin/tumble TUMBLE_CACHE=$build/Testing/cache PATH=$environment/bin:$build/bin:$PATH
hash -r
cd "$work"  # not in the sources: the installed package is what is tested
"$environment/bin/python" -m pytest -q -p no:cacheprovider "$tree/python/tests"
"$environment/bin/python" "$tree/tests/tutorials/follow.py" "$tree/docs/tutorials/python.md" "$work/tutorial"
