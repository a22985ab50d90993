# Files in the wrong places: what was given, what is wanted, and the line that says so.
try() {
    "$@"
    echo "status $?" >&2
}
cp "$fixtures"/* .
printf '{"format": "meso-constraints", "version": 1}\n' >rules.json
meso-map -q vase.meso -o vase.drc
try meso-solve vase.obj vase.tiles.json -o x.slots
try meso-solve vase.tiles.json vase.slots -o x.slots
try meso-solve vase.tiles.json gap.json -o x.slots
try meso-solve vase.tiles.json vase.drc -o x.slots
try meso-solve rules.json vase.obj -o x.slots
try meso-solve --constraints vase.tiles.json vase.tiles.json vase.obj -o x.slots
try meso-solve --keep vase.meso vase.tiles.json vase.obj -o x.slots
try meso-suggest gap.json gap.tiles.json -o x.json
try meso-suggest --surface gap.json gap.tiles.json -o x.json
try meso-map vase.slots vase.obj vase.tiles.json -o x.meso
try meso-map vase.tiles.json vase.slots vase.obj -o x.meso
try meso-map vase.tiles.json -o x.meso
try meso-render vase.slots -o x.png
try meso-tile check vase.obj
try meso-tile list gap.json
try meso-tile import vase.meso
ls x* 2>/dev/null
true
