# EXRs of several parts, and with a data window of what is there, as other programs read them; numbers of frames.
cp "$fixtures/vase.meso" .
render() { meso-render -q --visibility tiles --size 60x50 --samples 1 --aov all "$@"; }
render vase.meso -o full.exr
render --multipart vase.meso -o parts.exr
render --data-window tight vase.meso -o tight.exr
render --multipart --data-window tight vase.meso -o both.exr
exrheader parts.exr | sed -n 's/^name (type string): "\(.*\)"/\1/p'
exrheader both.exr | grep -E '^(data|display)Window' | sort | uniq -c | sed 's/^ *//'
exrheader tight.exr | grep -E '^(data|display)Window'
exrheader parts.exr | grep -c '^cryptomatte/.*/manifest'
exrheader parts.exr | grep -c '^meso:tiles'
exrinfo both.exr >/dev/null || echo "exrinfo: status $?"

# Each part has what the whole has, of both windows.
same() {
    oiiotool "$1" --ch "$3" "$2" --subimage "$4" --ch "$3" --diff | grep -E 'PASS|FAIL'
}
same full.exr parts.exr R,G,B,A rgba
same full.exr parts.exr slot,tile id
same full.exr parts.exr crypto_tile00.R,crypto_tile00.G crypto_tile
same tight.exr both.exr N.X,N.Y,N.Z N
oiiotool full.exr --ch R,G,B,A,N.X tight.exr --ch R,G,B,A,N.X --fullpixels --diff | grep -E 'PASS|FAIL'

# The same bytes in bands and on any number of threads.
cp both.exr whole.exr
render --threads 3 --band-rows 16 --multipart --data-window tight vase.meso -o both.exr
cmp both.exr whole.exr
# What the ground catches is there, too; of nothing one pixel is left.
render --data-window tight --ground shadow vase.meso -o ground.exr
exrheader ground.exr | grep '^dataWindow'
cp ground.exr whole.exr
render --data-window tight --ground shadow --band-rows 16 vase.meso -o ground.exr
cmp ground.exr whole.exr
render --data-window tight --eye 0,0,9 --target 0,0,19 vase.meso -o none.exr 2>/dev/null
exrheader none.exr | grep '^dataWindow'

meso-render -q --visibility tiles --size 32x32 --samples 1 --turntable 4 --frames 3 --fps 30000/1001 --multipart vase.meso \
    -o f-%d.exr
exrheader f-3.exr | grep -E 'imageCounter|framesPerSecond' | sort | uniq -c | sed 's/^ *//'
meso-render --visibility tiles --size 32x32 --samples 1 --turntable 4 --frames 3 --fps 30000/1001 --multipart --resume \
    vase.meso -o f-%d.exr
exrheader full.exr | grep -c -E 'imageCounter|framesPerSecond'
for fps in 0 x 24/ 24/0 24/1/2 -1; do
    meso-render --fps $fps vase.meso -o no.exr || echo "status $?"
done
