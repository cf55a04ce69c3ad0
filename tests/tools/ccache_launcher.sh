#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Tests the checksum of a precompiled header: it depends only on the header, and is deleted with the header. A fake
# ccache writes the given contents, or fails.
#   ccache_launcher.sh ROOT
set -eu
launcher=$1/estimator/cmake/ccache_launcher
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
fail() { echo "ccache_launcher: $*" >&2; exit 1; }

cat > ccache <<'STAND_IN'
#!/bin/sh
[ "$CONTENT" != none ] || exit 3
[ "$CCACHE_BASEDIR $CCACHE_PCH_EXTSUM" = '/base 1' ] || exit 4
while [ $# -gt 0 ]; do case $1 in -o) echo "$CONTENT" > "$2" ;; esac; shift; done
STAND_IN
chmod +x ccache
launch() { CONTENT=$1 sh "$launcher" ./ccache /base g++ -x c++-header -o "$2" -c header.hxx; }

launch one pch.gch
first=$(cat pch.gch.sum)
[ -n "$first" ] || fail 'a precompiled header has no sum'
launch one again.pch
[ "$(cat again.pch.sum)" = "$first" ] || fail 'the same header in another place has another sum'
launch two pch.gch
[ "$(cat pch.gch.sum)" != "$first" ] || fail 'another header has the same sum'
if launch none pch.gch; then fail 'the launcher hides a failure of the compiler'; fi
[ ! -e pch.gch ] && [ ! -e pch.gch.sum ] || fail 'the old header or its sum remains after a failed compilation'
launch three source.o
[ -e source.o ] && [ ! -e source.o.sum ] || fail 'an object file has a sum'
