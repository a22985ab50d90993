# Another seed, another weave; every seed solves the vase.
for seed in 0 1 2 3 4 5 6 7; do
    meso-solve -q --seed $seed "$fixtures/vase.tiles.json" "$fixtures/vase.obj" -o $seed.slots || echo "seed $seed: $?"
done
cmp -s 0.slots 1.slots && echo "the same weave"
true
