# Wrong command lines: one line, status 2, no output.
try() {
    "$@"
    echo "status $?" >&2
}
cp "$fixtures"/vase.* .
try meso-solve
try meso-solve vase.tiles.json -o x.slots
try meso-solve --seed 12x vase.tiles.json vase.obj -o x.slots
try meso-solve --seed -1 vase.tiles.json vase.obj -o x.slots
try meso-solve --attempts 0 vase.tiles.json vase.obj -o x.slots
try meso-solve --seed
try meso-solve --quiet=yes vase.tiles.json vase.obj -o x.slots
try meso-map vase.meso -o x.unknown
try meso-map --divisions 1 vase.meso -o x.ply
try meso-map --thickness nan vase.meso -o x.ply
try meso-map vase.tiles.json vase.obj -o x.ply
try meso-render --size 0x10 vase.meso -o x.png
try meso-render --size 99999x10 vase.meso -o x.png
try meso-render --eye 1,2 vase.meso -o x.png
try meso-render --samples 3 vase.meso -o x.png
try meso-suggest vase.tiles.json
try meso-tile nonsense vase.tiles.json
try meso-solve --json=report.json vase.tiles.json vase.obj -o -
try meso-solve vase.tiles.json vase.obj
ls x* 2>/dev/null
true
