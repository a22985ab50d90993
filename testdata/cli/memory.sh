# One allocation fails, or all from one on: a tool ends with 33, or with the right product, and leaves nothing broken.
# The n-th is tried for every n in steps that make $most runs of each command line.
most=30
cp "$testdata/cli/quad.tiles.json" "$fixtures/basket.json" .
cat >cube.obj <<END
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 0 0 1
v 1 0 1
v 1 1 1
v 0 1 1
f 1 4 3 2
f 5 6 7 8
f 1 2 6 5
f 2 3 7 6
f 3 4 8 7
f 4 1 5 8
END
meso-solve -q quad.tiles.json cube.obj -o cube.slots
meso-map -q quad.tiles.json cube.obj cube.slots -o cube.meso
meso-map -q cube.meso -o cube.glb

# What ended with status $1, of "$2..." with allocation $fail failing, must be as it should.
judge() {
    status=$1
    shift
    if [ "$status" = 0 ]; then
        diff -r right out >differences && return
        echo "status 0, but other bytes: FAIL_MALLOC=$fail $*"
    elif [ "$status" = 33 ]; then
        # What is there of many seeds is there to go on with: whole lines.
        [ ! -e out/lines.jsonl.partial ] || grep -v '^{.*}$' out/lines.jsonl.partial
        rm -f out/*.partial out/stdout
        # The report of a failure is there too, whole, and says what it was.
        if [ -e out/cube.json ] && grep -q '"status": "memory"' out/cube.json; then
            meso-info -q out/cube.json >/dev/null && rm out/cube.json
        fi
        for file in out/* out/.[!.]*; do
            [ ! -e "$file" ] || cmp -s "$file" "right/${file#out/}" || echo "left $file: FAIL_MALLOC=$fail $*"
        done
    else
        echo "status $status: FAIL_MALLOC=$fail $*"
        cat err
    fi
}

try() {
    fail=$1 status=0
    shift
    rm -rf out
    mkdir out
    FAIL_MALLOC=$fail LD_PRELOAD=$generators/fail_malloc.so "$@" >out/stdout 2>err || status=$?
    judge $status "$@"
}

each() {
    rm -rf out right
    mkdir out
    FAIL_MALLOC_COUNT=count LD_PRELOAD=$generators/fail_malloc.so "$@" >out/stdout || echo "$*: fails"
    mv out right
    count=$(cat count)
    [ "$count" -gt 100 ] || echo "$*: only $count allocations counted"
    step=$((count / most + 1))
    n=1
    while [ $n -le "$count" ]; do
        try $n "$@"
        n=$((n + step))
    done
    try $((count / 3))+ "$@"
    try $((2 * count / 3))+ "$@"
}

each meso-tile list quad.tiles.json
each meso-tile check quad.tiles.json
each meso-tile import -q basket.json -o out/basket.tiles.json
each meso-solve -q --threads 1 --report out/why.json quad.tiles.json cube.obj -o out/cube.slots
each meso-solve -q --threads 1 --engine exact quad.tiles.json cube.obj -o out/cube.slots
each meso-solve -q --threads 1 --seeds 1-3 --each out/%d.slots quad.tiles.json cube.obj -o out/lines.jsonl
each meso-map -q --threads 1 quad.tiles.json cube.obj cube.slots -o out/cube.meso
for kind in ply obj glb drc stl usda; do
    each meso-map -q --threads 1 cube.meso -o out/cube.$kind
done
each meso-map -q --threads 1 --compress draco cube.meso -o out/cube.glb
each meso-map -q --threads 1 --weld --cap-borders cube.meso -o out/cube.ply
each meso-mesh -q --threads 1 weld=0.1 clean separate orient subdivide=2 info cube.obj -o out/cube.obj --json=out/cube.json
each meso-mesh -q --threads 1 subdivide=linear,2 decimate=50% cube.obj -o out/cube.ply
cp "$fixtures"/*.pattern.json "$fixtures/flowers.macros.json" "$fixtures/vase.obj" .
each meso-decor -q --threads 1 eleven-steps.pattern.json vase.obj -o out/v.meso --tree out/v.json --lines out/v.svg
each meso-decor -q --threads 1 --seeds 1-2 procedural.pattern.json vase.obj -o out/%d.glb
each meso-quilt -q --threads 1 --guide auto --swatch wire --sides 3 --scale 0.3 --until 4 cube.obj -o out/v.quilt
cp "$fixtures"/*.grammar "$fixtures/crack.tiles.json" .
most=300
each meso-grow -q --threads 1 --until 4 ivy.grammar cube.obj -o out/i.meso
most=30
each meso-grow -q --threads 1 --until 3 --trace out/c.jsonl cracks.grammar cube.obj -o out/c.svg
each meso-decor -q --threads 1 --geodesics exact polyline-closed.pattern.json vase.obj -o out/v.ply --lines out/v.obj
sed 's/"count": 80/"count": 12/' "$fixtures/knobs.details.json" >knobs.details.json
meso-replicate -q --deform stretch --count 2 cube.obj -o body-%d.obj
each meso-replicate -q --threads 1 --fineness 3 --frames 1 --state out/k.state knobs.details.json body-%d.obj -o out/k-%d.ply
each meso-replicate -q --threads 1 --fineness 3 --mode play --plan out/k.plan knobs.details.json body-%d.obj -o out/k.glb
each meso-check -q --threads 2 --max-faults 9999 --mark out/marks.ply cube.meso -o out/found.json
for file in quad.tiles.json cube.obj cube.slots cube.meso cube.glb; do
    each meso-info $file
done
