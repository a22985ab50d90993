# How a product came to be, with how its inputs did; the same wherever, and however spelled, the job was.
mkdir one two
(
    cd one
    cp "$fixtures/vase.tiles.json" "$fixtures/vase.obj" .
    meso-solve -q --seed 2 vase.tiles.json vase.obj -o vase.slots
    meso-map -q vase.tiles.json vase.obj vase.slots -o vase.meso
    for kind in ply obj drc glb; do
        meso-map -q --divisions 5 vase.meso -o mesh.$kind
    done
    meso-render -q --visibility tiles --size 40x30 vase.meso -o vase.exr --png vase.png
)
(
    cd two
    cp ../one/vase.tiles.json ../one/vase.obj .
    mkdir out
    here=$PWD
    meso-solve --engine auto --conflicts 2000000 --orient file -v --threads 1 "$here/vase.tiles.json" ./vase.obj \
        --seed 02 --attempts 20 --report out/report.json -o - 2>/dev/null >vase.slots
    meso-map -q --to meso ../two/vase.tiles.json "$here/vase.obj" --divisions=12 --offset 0 --tangent-scale 1.0 \
        --section-step 2e-2 --mesh-path nowhere/ "$here/vase.slots" -o - >vase.meso
    for kind in ply obj drc glb; do
        case $kind in
            drc) spelled='--speed 7 --position-bits 14 --normal-bits 10' ;;
            glb) spelled='--compress none --up y --unit 1.0' ;;
            *) spelled= ;;
        esac
        # shellcheck disable=SC2086
        meso-map -q --to $kind --seed 0 $spelled ../two/vase.meso --divisions 05 --json=out/map.json -o - >mesh.$kind
        # Without a name there is no file of materials to go with it.
        [ $kind != obj ] || meso-map -q ../two/vase.meso --divisions 5 -o ./mesh.obj
    done
    meso-render -q --visibility tiles ./vase.meso --fov 30 --samples 4 --ground none --size 40x30 --to exr \
        -o - --png vase.png >vase.exr
    grep '"command"' out/*.json
    rm -r out
)
diff -rq one two && echo "the same bytes"

commands() {
    meso-info "$1" | sed -n 's/ *"command": //p'
}
cd one
for file in vase.slots vase.meso mesh.ply mesh.obj mesh.drc mesh.glb vase.exr vase.png; do
    commands $file | tail -n 1
done
# The whole chain, but for the hashes.
chain() {
    meso-info "$1" | sed -n -e 's/"[0-9a-f]\{32\}"/"..."/' -e '/"provenance"/,/^  },/p'
}
chain vase.png
# A default that overrides what the model has is part of the job.
meso-map -q --divisions 12 vase.meso -o over.ply
commands over.ply | head -n 1
# No line of a comment is longer than some readers take.
head -n 12 mesh.ply | LC_ALL=C cut -c1-1000 | cksum >cut
head -n 12 mesh.ply | cksum | cmp - cut

# The tile set's, the report's, and what a surface was made by.
meso-solve -q --report gap.json "$fixtures/gap.tiles.json" vase.obj -o gap.slots 2>/dev/null || true
meso-suggest -q "$fixtures/gap.tiles.json" gap.json -o mended.tiles.json
meso-solve -q mended.tiles.json vase.obj -o mended.slots
commands mended.slots

# As typed, and none.
meso-map -q --provenance full ./vase.meso --threads 2 --to ply --divisions 05 -o ../one/full.ply
commands full.ply | head -n 1
meso-map -q --provenance none vase.meso -o none.obj
head -n 1 none.obj
meso-solve -q --provenance none vase.tiles.json vase.obj -o none.slots
meso-map -q vase.tiles.json vase.obj none.slots -o none.meso
chain none.meso
