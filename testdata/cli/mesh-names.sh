# Meshes that tiles name: a blank at the end, and a tile set that moves to another folder.
mkdir sets sets/old new
printf 'v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n' >sets/knob.obj
printf 'v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n' >quad.obj
sed 's|{"name": "cross",|& "inner": [{"mesh": "../knob.obj "}],|' "$testdata/cli/quad.tiles.json" >sets/old/set.json

grow() {
    meso-solve -q --constraints pins.json "$1" quad.obj -o x.slots && meso-map -q "$1" quad.obj x.slots -o x.ply &&
        grep -ac 'end_header' x.ply
}
printf '{"format": "meso-constraints", "version": 1, "pins": [{"slot": 0, "tile": "cross"}]}\n' >pins.json
grow sets/old/set.json
meso-tile import -q sets/old/set.json -o new/set.json
grep -o '"mesh": "[^"]*"' new/set.json
grow new/set.json
meso-tile check --strict new/set.json
meso-tile import -q sets/old/set.json | grep -o '"mesh": "[^"]*"'
