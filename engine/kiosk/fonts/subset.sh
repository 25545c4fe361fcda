#!/usr/bin/env bash
# Makes the four fonts of this folder anew: `bash engine/kiosk/fonts/subset.sh` from the root of the repository.
#
# Reads: Noto Sans and Noto Sans CJK JP (Debian: fonts-noto-core, fonts-noto-cjk), engine/kiosk/texts/ja.ftl.
# Needs: pyftsubset (Python: fonttools). Writes: the four files beside this one.
set -euo pipefail

here="$(cd "$(dirname "$0")" && pwd)"
texts="$here/../texts"
latin="${NOTO_LATIN:-/usr/share/fonts/truetype/noto}"
japanese="${NOTO_JAPANESE:-/usr/share/fonts/opentype/noto}"

# Latin with Turkish and all of Western Europe, dashes, quotes, the signs of measures and prices, arrows.
signs="U+0020-007E,U+00A0-017F,U+2010-2015,U+2018-201F,U+2020-2022,U+2026,U+2030,U+2032-2033,U+2039-203A,U+20AC,U+2122,U+2190-2193,U+2212,U+2248,U+2264-2265"
# Kana and its marks whole, so that a changed word seldom needs a new font; kanji only as they are written.
kana="U+3000-3002,U+3005,U+3008-3011,U+3014-3015,U+301C,U+3041-3096,U+3099-309E,U+30A0-30FF,U+FF01-FF5E"

subset() {
    local from="$1" number="$2" to="$3"
    shift 3
    pyftsubset "$from" --font-number="$number" --output-file="$here/$to" --no-hinting --layout-features=kern,mark,mkmk,locl \
        --name-IDs=0,1,2,5,13,14 --drop-tables+=DSIG,vhea,vmtx,VORG,BASE "$@"
}

for weight in Regular Bold; do
    subset "$latin/NotoSans-$weight.ttf" 0 "NotoSans-$weight.ttf" --unicodes="$signs"
    subset "$japanese/NotoSansCJK-$weight.ttc" 0 "NotoSansJP-$weight.otf" --unicodes="$kana" --text-file="$texts/ja.ftl"
done
ls -l "$here"
