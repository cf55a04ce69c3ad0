#!/usr/bin/env bash
# Builds the package of python/ as for distribution and tests it in a separate environment.
#   package_test.sh TREE BUILD    BUILD contains bin/tumble; the environment and compiled files remain in BUILD/python
set -euo pipefail
tree=$1 build=$2 work=$2/python
environment=$work/environment
mkdir -p "$work"
[ -x "$environment/bin/python" ] || /usr/bin/python3 -m venv "$environment"
pip() { "$environment/bin/python" -m pip install --quiet --disable-pip-version-check "$@"; }

# builds the wheel from the source distribution; checks its size, and that it needs only shared libraries that every
# system has
"$tree/python/make_wheel" "$work/wheel"
wheel=$(echo "$work"/wheel/dist/*.whl)
pip --force-reinstall --no-deps "$wheel"
pip "$wheel[test]"
"$environment/bin/python" "$tree/tests/python/wheel_check.py" "$environment" "$work/wheel/dist"
# builds the compiled part of tumble.evalio, with a nanobind of evalio's ABI
pip 'evalio>=0.6.1,<0.7' 'nanobind>=2.13,<2.15' 'scikit-build-core>=1.1,<2' ninja
pip --force-reinstall --no-deps --no-build-isolation "$tree/python/evalio" --config-settings=build-dir="$work/evalio"

export TUMBLE_ROOT=$tree TUMBLE_PROGRAM=$build/bin/tumble TUMBLE_CACHE=$build/Testing/cache PATH=$environment/bin:$build/bin:$PATH
hash -r
cd "$work"  # outside of the sources, so that the installed package is tested
"$environment/bin/python" -m pytest -q -p no:cacheprovider "$tree/python/tests"
"$environment/bin/python" "$tree/tests/tutorials/follow.py" "$tree/docs/tutorials/python.md" "$work/tutorial"
