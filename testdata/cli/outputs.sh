# No tool writes over what it reads, or two things to one file; nothing is touched where it is refused.
cp "$fixtures"/vase.* .
cp vase.obj torus.obj
ln torus.obj hard.obj
ln -s torus.obj soft.obj
mkdir there
ln -s there here
find . -type f ! -name before -exec cksum {} + | sort >before

refuse() {
    status=0
    "$@" 2>err >out || status=$?
    echo "$status $(head -n 1 err)"
    [ ! -s out ] || echo "something was said"
}
refuse meso-solve vase.tiles.json torus.obj -o torus.obj
refuse meso-solve vase.tiles.json torus.obj -o ./hard.obj
refuse meso-solve vase.tiles.json torus.obj -o soft.obj
refuse meso-solve vase.tiles.json soft.obj -o x --report torus.obj
refuse meso-solve vase.tiles.json torus.obj -o x --json=torus.obj
refuse meso-solve --nonsense vase.tiles.json torus.obj -o x --json=torus.obj
refuse meso-solve vase.tiles.json torus.obj -o x --report ./x
refuse meso-solve vase.tiles.json torus.obj -o there/x --report here/x
refuse meso-solve vase.tiles.json torus.obj -o x --keep vase.slots --report vase.slots
refuse meso-solve vase.tiles.json torus.obj -o x.cnf --proof x
refuse meso-solve vase.tiles.json - -o torus.obj <torus.obj
refuse meso-solve --seeds 1-3 vase.tiles.json torus.obj -o x --best loops=./x
refuse meso-solve --seeds 1-3 vase.tiles.json torus.obj -o x --best loops=torus.obj
refuse meso-solve --seeds 1-3 vase.tiles.json torus.obj -o x --best loops=x.partial
cp torus.obj torus2
refuse meso-solve --seeds 1-3 vase.tiles.json torus2 -o x --each torus%d
refuse meso-solve --seeds 1-3 vase.tiles.json torus.obj -o x2 --each x%d
ln -s 1 2
refuse meso-solve --seeds 1-3 vase.tiles.json torus.obj -o x --each %d
rm torus2 2
refuse meso-suggest vase.tiles.json --surface torus.obj -o vase.tiles.json
refuse meso-map vase.meso -o vase.meso
refuse meso-map vase.tiles.json vase.obj vase.slots --to ply -o vase.slots
refuse meso-map --json=same.meso vase.meso -o same.meso
refuse meso-render vase.meso -o x.png --png ./x.png
refuse meso-render vase.meso -o x.exr --png vase.meso
refuse meso-tile import vase.tiles.json -o vase.tiles.json
refuse meso-tile list vase.tiles.json -o vase.tiles.json
refuse meso-info vase.slots -o vase.slots
refuse meso-quilt --swatch nuts torus.obj --to ply -o torus.obj
refuse meso-quilt --swatch nuts torus.obj --to quilt -o ./hard.obj
refuse meso-quilt torus.obj vase.obj --to meso -o torus.obj
refuse meso-quilt --swatch nuts --plane 4x4 -o x.quilt --json=./x.quilt
refuse meso-quilt -q --swatch nuts --guide torus.obj vase.obj --to obj -o torus.obj

# A mesh that only the tile set names.
sed 's/"sweeps"/"inner": [{"mesh": "torus.obj"}], "sweeps"/' "$testdata/cli/quad.tiles.json" >inner.tiles.json
printf 'v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n' >quad.obj
meso-solve -q inner.tiles.json quad.obj -o quad.slots
refuse meso-map inner.tiles.json quad.obj quad.slots --to obj -o torus.obj
rm inner.tiles.json quad.obj quad.slots err out
find . -type f ! -name before -exec cksum {} + | sort | cmp - before

# What is nobody's file may be used twice, and a report may say that an output was refused.
meso-solve -q vase.tiles.json torus.obj -o /dev/null --report /dev/null
refuse meso-map vase.meso -o vase.meso --json=report.json
grep '"exit"' report.json
