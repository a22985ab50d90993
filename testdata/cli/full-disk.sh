# A disk that fills up while each tool writes: one line, status 5, nothing left.
cp "$fixtures"/vase.* "$fixtures/ivy.grammar" .
mkdir disk
if mount -t tmpfs -o size=64k tmpfs disk 2>/dev/null; then
    trap 'umount disk' EXIT
fi
# Where nothing may be mounted, a limit on the size of files stands in.
try() {
    (cd disk && ulimit -f 128 && "$@" 2>../said)
    echo "status $?"
    sed -e 's/No space left on device/full/' -e 's/File too large/full/' said
    ls -A disk
}
try meso-map -q ../vase.meso -o x.ply
try meso-map -q ../vase.meso -o x.obj
try meso-map -q ../vase.meso -o x.glb
try meso-map -q ../vase.meso -o x.drc
try meso-quilt -q --swatch nuts --plane 4x4 -o x.quilt
try meso-grow -q ../ivy.grammar ../vase.obj -o x.svg
try meso-render -q --size 256x256 ../vase.meso -o x.exr
try meso-render -q --size 256x256 ../vase.meso -o x.png
head -c 60000 /dev/zero >disk/ballast
# A file of the same name stays as it was.
echo old >disk/x.ply
(cd disk && ulimit -f 128 && meso-map -q ../vase.meso -o x.ply 2>/dev/null)
cat disk/x.ply
