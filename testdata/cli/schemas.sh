# What the tools write is what the installed JSON Schemas say, and other things are not.
cp "$fixtures"/* .
schemas=$PWD/schemas
mkdir schemas
cp $(find "$(dirname "$scripts")/formats" -name "*.schema.json") schemas

# Reports of every tool and of every status that a run can have.
report() {
    number=$((number + 1))
    "$@" --json=report-$number.json 2>/dev/null >/dev/null
}
number=0
constraints='{"format": "meso-constraints", "version": 1, "pins": [{"name": "first", "slot": 0, "tile": "%s"}], "weights": {"reed loops": 2.5}}'
printf "$constraints" double >no.json
printf "$constraints" "reed end" >pin.json
report meso-solve vase.tiles.json vase.obj -v -o x.slots
report meso-solve gap.tiles.json vase.obj -o x.slots
report meso-solve vase.tiles.json vase.obj --constraints no.json -o x.slots
report meso-solve vase.tiles.json vase.obj --constraints no.json --engine wfc --attempts 1 --observations 1 -o x.slots
report meso-solve vase.tiles.json vase.obj --engine wfc --observations 3 -o x.slots
report meso-solve vase.tiles.json vase.obj --keep vase.slots --orient comb -o x.slots
report meso-solve vase.tiles.json vase.obj --seeds 1-3 --best loops -o x.jsonl
report meso-solve vase.tiles.json none.obj -o x.slots
report meso-solve vase.tiles.json vase.obj -o none/x.slots
report meso-solve --nonsense
report meso-check --fast --max-faults 99999 vase.meso
meso-map -q --bends drawn vase.meso -o drawn.meso
report meso-check --fast drawn.meso
report meso-suggest gap.tiles.json gap.json -o x.tiles.json
report meso-suggest vase.tiles.json --surface vase.obj -o x.json
report meso-tile import basket.json -o x.tiles.json
report meso-tile check vase.tiles.json -o x.txt
report meso-tile check no.json -o x.txt
report meso-tile list vase.tiles.json -o x.txt
report meso-map vase.tiles.json vase.obj vase.slots -o x.meso
report meso-map vase.meso -o x.drc
report meso-render --size 40x30 vase.meso -o x.png
report meso-render --size 40x30 --ortho 0 vase.meso -o x.png
report meso-info vase.slots -o x.json
report meso-mesh info vase.obj
report meso-decor eleven-steps.pattern.json vase.obj -o x.ply
report meso-quilt --swatch nuts --columns 2 --rows 2 -o nuts.ply
report meso-quilt -v --check nuts.ply --plane 4x4 -o x.quilt
report meso-quilt --embed charts --until 2 --swatch wire --sides 4 --scale 0.1 vase.obj -o x.glb
report meso-quilt nuts.ply --plane 0.1x0.1 -o x.quilt
report meso-map vase.meso --provenance none -o x.ply
report meso-map vase.meso --provenance full -o x.ply
meso-solve -q vase.tiles.json vase.obj -o x.slots --report solved.json
meso-solve -q vase.tiles.json vase.obj -o x.slots --constraints no.json --report unsolvable.json 2>/dev/null
meso-solve -q --engine wfc --observations 3 --seeds 1-2 vase.tiles.json vase.obj 2>/dev/null >gave-up.jsonl
meso-solve -q --seeds 1-2 gap.tiles.json vase.obj 2>/dev/null >unsolvable.jsonl

meso-info --slots json vase.slots >listing.json

meso-decor -q --tree tree.json macros-square.pattern.json vase.obj -o x.ply
meso-decor -q --tree grown-tree.json procedural.pattern.json vase.obj -o x.ply
printf '{"format": "meso-pattern", "version": 1, "steps": [{"displace": 0.1}]}' >idle.json
meso-decor -q --tree whole-tree.json idle.json vase.obj -o x.ply

cat >x.camera.json <<END
{"format": "meso-camera", "version": 1, "comment": "one of each", "keys": [
  {"frame": 1, "eye": [0, 1, 4], "target": [0, 0.5, 0], "focal": 50, "sensor": 24}, {"frame": 9, "fov": 30, "up": [0, 0, 1]}]}
END

# Broken ones, each in one place.
sed 's/"fov": 30/"fov": 30, "ortho": 2/' x.camera.json >broken-9.json
sed 's/"solved"/"perhaps"/' solved.json >broken-1.json
sed 's/"initial": true/"initial": 1/' gap.json >broken-2.json
sed 's/"status": "ok"/"status": "no"/' report-1.json >broken-3.json
sed 's/"loops"/"rings"/' x.jsonl >broken.jsonl
sed 's/2.5/-2.5/' no.json >broken-4.json
sed 's/"patches"/"patchwork"/' "$(grep -l '"tool": "meso-quilt"' $(grep -l '"check"' report-*.json))" >broken-8.json

sed 's/"#8f4a33"/"#8f4a3"/' "$testdata/patterns/contour-line.pattern.json" >broken-5.json
sed 's/"parameters": {/"parameters": [{/; s/"heart": null}/"heart": null}]/' "$testdata/patterns/flowers.macros.json" >broken-6.json
sed 's/"triangles"/"leaves"/; s/"tag": "surface"/"tag": "cellar"/' whole-tree.json >broken-7.json

sed -n 's/.*"status": "\(.*\)",/\1/p' report-*.json | sort | uniq -c

validate() {
    schema=$1
    shift
    NODE_PATH=$npm/node_modules node "$scripts/validate-json.mjs" "$schemas/meso-$schema.schema.json" "$@" 2>&1
}
if [ -d "$npm/node_modules/ajv" ]; then
    validate report report-*.json solved.json unsolvable.json gap.json
    validate seeds x.jsonl gave-up.jsonl unsolvable.jsonl
    validate tiles vase.tiles.json x.tiles.json "$testdata/teapot.tiles.json"
    validate constraints no.json pin.json
    validate slots listing.json
    validate pattern "$testdata"/patterns/*.pattern.json
    validate macros "$testdata/patterns/flowers.macros.json" "$(dirname "$scripts")/formats/decor/macros.json"
    validate regions tree.json grown-tree.json whole-tree.json
    validate details "$testdata"/details/*.details.json
    validate deform "$testdata"/details/*.deform.json
    validate camera x.camera.json
    validate report broken-[1238].json
    validate seeds broken.jsonl
    validate constraints broken-4.json
    validate pattern broken-5.json
    validate macros broken-6.json
    validate regions broken-7.json
    validate camera broken-9.json
elif [ -n "${CI:-}" ]; then     # elsewhere scripts/setup has said that it could not install it
    echo "ajv is not installed" >&2
else
    grep '^broken' "$testdata/cli/schemas.out"
fi
true
