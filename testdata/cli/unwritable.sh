# Outputs that cannot be written: one line, status 5, nothing left.
cp "$fixtures"/vase.* .
try() {
    "$@"
    echo "status $?" >&2
}
mkdir folder
try meso-solve -q vase.tiles.json vase.obj -o /proc/x.slots
try meso-map -q vase.meso -o missing/x.ply
try meso-map -q vase.meso -o folder/
try meso-map -q --to ply vase.meso -o folder
try meso-map -q --to ply vase.meso -o /dev/full
try meso-map -q --to ply vase.meso -o - >/dev/full
try meso-render -q --size 32x32 vase.meso -o vase.obj/x.png
try meso-quilt -q --swatch nuts --plane 4x4 -o missing/x.quilt
try meso-quilt -q --swatch nuts --plane 4x4 --to quilt -o /dev/full
try meso-quilt -q --swatch nuts --plane 4x4 --to ply -o - >/dev/full
try meso-quilt -q --swatch nuts --plane 4x4 --json=missing/x.json -o x.quilt
try meso-quilt -q --swatch nuts --to ply -o - >/dev/full
(trap '' PIPE && { meso-quilt -q --swatch nuts --plane 4x4 --to quilt -o -; echo "status $?" >&2; } | :)
(trap '' PIPE && { meso-map -q --to ply vase.meso -o -; echo "status $?" >&2; } | :)
ls -A folder
true
