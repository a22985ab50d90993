# Parts of a product, by slots and by shares; together they are the product.
cp "$fixtures"/vase.* .
coarse='-q --divisions 4 --section-step 0.2'
meso-map $coarse vase.meso -o whole.ply
for share in 1 2 3; do
    # shellcheck disable=SC2086
    meso-map $coarse --shard $share/3 vase.meso -o share-$share.ply
done
for slots in 0-59 60-119 120-239; do
    # shellcheck disable=SC2086
    meso-map $coarse --slots $slots vase.meso -o slots-$slots.ply
done
meso-map --join share-3.ply share-1.ply share-2.ply -o joined.ply
cmp whole.ply joined.ply && echo "shares are the whole"
meso-map --join slots-*.ply --to ply -o - | cmp - whole.ply && echo "slots are the whole"

# Each is a file by itself; rows of its vertices lie in the whole.
meso-mesh info share-2.ply | grep '"vertices"'
for kind in obj glb drc stl usda; do
    meso-map $coarse --shard 2/3 --json=report vase.meso -o part.$kind
    grep '"vertices"' report
done

try() { "$@"; echo "status $?"; }
try meso-map --join share-1.ply share-3.ply -o x.ply
try meso-map --join share-1.ply share-1.ply share-2.ply -o x.ply
try meso-map --join share-1.ply whole.ply -o x.ply
meso-map -q --divisions 5 --shard 2/3 vase.meso -o other.ply
try meso-map --join share-1.ply other.ply -o x.ply
try meso-map --join share-1.ply share-2.ply share-3.ply -o share-1.ply
try meso-map --join share-1.ply share-2.ply share-3.ply -o x.obj
try meso-map --join --shard 1/2 share-1.ply -o x.ply
try meso-map --slots 9-3 vase.meso -o x.ply
try meso-map --slots 3 vase.meso -o x.ply
try meso-map --shard 4/3 vase.meso -o x.ply
try meso-map --shard 0/3 vase.meso -o x.ply
try meso-map --slots 0-3 --shard 1/3 vase.meso -o x.ply
try meso-map --shard 1/3 vase.meso -o x.meso
try meso-map --slots 1000-2000 vase.meso -o x.ply
try meso-map vase.tiles.json vase.obj vase.slots vase.meso -o x.ply
ls x.* 2>/dev/null
true
