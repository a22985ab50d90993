# A sheet of a tile set has every tile, its interfaces and names on it; what is refused.
cp "$fixtures/vase.tiles.json" "$fixtures/vase.obj" .
meso-render --visibility tiles --size 200x130 --samples 1 --aov cryptomatte --tiles vase.tiles.json -o sheet.exr --png sheet.png --json=said
exrheader sheet.exr | grep 'manifest.*plain"' | tr ',{}' '\n' | sed -n 's/^"\(.*\)":.*/\1/p'
grep -c '"tiles"' said
meso-render -q --size 200x130 --samples 1 --turntable 4 --frames 2 --tiles vase.tiles.json -o turn-%d.png
cmp -s turn-2.png sheet.png && echo "it does not turn"
sed 's/"plain"/"plain ä, and a long one"/' vase.tiles.json >long.tiles.json
meso-render -q --size 64x64 --samples 1 --tiles long.tiles.json -o long.png

refuse() {
    status=0
    meso-render --size 32x32 "$@" || status=$?
    echo "status $status"
}
refuse --tiles vase.tiles.json "$fixtures/vase.meso" -o x.png
refuse --tiles vase.obj -o x.png
refuse --mesh-path . "$fixtures/vase.meso" -o x.png
refuse -o x.png
sed 's/"name": "plain"/"name": "plain", "inner": [{"mesh": "none.obj"}]/' vase.tiles.json >inner.tiles.json
refuse --tiles inner.tiles.json -o x.png
ls x.png 2>/dev/null
true
