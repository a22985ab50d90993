# The same command gives the same bytes, run twice and with one or two threads.
for folder in one two again; do
    threads=1
    [ $folder = one ] || threads=2
    mkdir $folder
    (
        cd $folder
        cp "$fixtures/vase.tiles.json" "$fixtures/vase.obj" .
        meso-solve -q --seed 5 --threads $threads --report vase.json vase.tiles.json vase.obj -o vase.slots
        meso-map -q --threads $threads vase.tiles.json vase.obj vase.slots -o vase.meso
        for kind in ply obj drc glb; do
            meso-map -q --threads $threads --divisions 6 vase.meso -o vase.$kind
        done
        meso-render -q --threads $threads --size 320x240 vase.meso -o vase.exr --png vase.png
    )
done
ls one
diff -rq one two
diff -rq two again
