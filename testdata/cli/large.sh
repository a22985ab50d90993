# A model whose sweeps are made when they are wanted has the picture of the one that is read whole, on any number of
# threads: with all that is in it, from within, and with motion.
render() { meso-render -q --visibility tiles --size 32x20 "$@" -o p.exr; }
# same THREADS OPTIONS...
same() {
    threads=$1
    shift
    render "$@"
    mv p.exr stored.exr
    render --threads "$threads" --stored-sweeps 1 "$@"
    cmp p.exr stored.exr
}
same 1 --samples 1 --aov all --ground shadow "$fixtures/vase.meso"
same 3 --samples 1 --aov all --ground shadow "$fixtures/vase.meso"
same 2 --samples 4 --light studio "$fixtures/vase.meso"
same 3 --samples 1 --ortho 3 "$fixtures/vase.meso"
same 2 --samples 1 --eye 0,0.5,0 --target 1,0.6,0.2 "$fixtures/vase.meso"
same 2 --samples 4 --light studio --visibility gl "$fixtures/vase.meso"

for number in 1 2; do
    meso-map -q --thickness 0.3$number "$fixtures/vase.tiles.json" "$fixtures/vase.obj" "$fixtures/vase.slots" \
        -o swell-$number.meso
done
for stored in 0 1; do
    meso-render -q --visibility tiles --size 32x20 --samples 1 --aov motion --frames 1 --stored-sweeps $stored \
        swell-%d.meso -o swell-%d-$stored.exr
done
cmp swell-1-0.exr swell-1-1.exr
