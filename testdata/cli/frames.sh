# Frames of a turn, of key cameras, of models by number: each the same bytes as alone; what is done is left, what is not
# whole or not of this model is drawn again; several processes share the work; names that do not fit are refused.
cp "$fixtures"/vase.meso .
cat >vase.camera.json <<END
{"format": "meso-camera", "version": 1, "keys": [
  {"frame": 1, "eye": [0, 1, 4], "target": [0, 0.5, 0]},
  {"frame": 5, "eye": [3, 1, 3], "fov": 50},
  {"frame": 9, "eye": [4, 1, 0]}]}
END
small='--visibility tiles --size 40x30 --samples 1'
meso-render $small --turntable 4 vase.meso -o turn-%04d.png
ls turn-*.png
meso-render -q $small --turntable 4 --frames 3 vase.meso -o one-%d.png
cmp turn-0003.png one-3.png
meso-render -q $small vase.meso -o still.png
cmp -s turn-0002.png turn-0001.png && echo "it does not turn"
meso-render -q $small --keys vase.camera.json --frames 1-9x4,2 vase.meso -o key-%02d.exr --png key-%02d.png
ls key-*

# Resumed: whole frames stay as they are.
rm turn-0002.png
touch -d '2000-01-01' turn-*.png
meso-render $small --turntable 4 --resume vase.meso -o turn-%04d.png
find . -name 'turn-*.png' -newermt '2001-01-01' | sort
cp turn-0001.png whole.png
head -c 500 whole.png >turn-0001.png
meso-render $small --turntable 4 --resume vase.meso -o turn-%04d.png
cmp whole.png turn-0001.png
meso-render $small --turntable 4 --resume --background 1,1,1 vase.meso -o turn-%04d.png

# Shared: each frame is drawn once.
for worker in 1 2 3; do
    meso-render $small --turntable 12 --resume vase.meso -o shared-%04d.png 2>said.$worker &
done
wait
sed -n 's/.* \([0-9]*\) frames\{0,1\} drawn.*/\1/p' said.1 said.2 said.3 | awk '{n += $1} END {print n " drawn by three"}'
ls shared-*.png | wc -l
ls -A | grep claim

# Models by number.
cp vase.meso model-0003.meso
cp vase.meso model-0004.meso
meso-render $small model-%04d.meso -o m-%04d.png
cmp -s m-0003.png still.png && echo "they do not name their models"
ls m-*.png

refuse() {
    status=0
    meso-render $small "$@" || status=$?
    echo "status $status"
}
refuse --turntable 4 vase.meso -o x.png
refuse --turntable 4 vase.meso -o x-%d.png --png y.png
refuse --frames 1-4 vase.meso -o x-%d.png
refuse --turntable 4 --keys vase.camera.json vase.meso -o x-%d.png
refuse --keys vase.camera.json --eye 1,2,3 vase.meso -o x-%d.png
refuse --turntable 4 --frames 1-x vase.meso -o x-%d.png
refuse none-%04d.meso -o x-%d.png
for keys in '[]' '[{"frame": 1}]' '[{"frame": 2, "eye": [0, 0, 1], "target": [0, 0, 0]}, {"frame": 2}]' \
    '[{"frame": 1, "eye": [0, 0, 1], "target": [0, 0, 1]}]' '[{"frame": 1, "eye": [0, 0], "target": [0, 0, 1]}]' \
    '[{"frame": 1, "eye": [0, 0, 1], "target": [0, 0, 0], "fov": 30, "ortho": 3}]' \
    '[{"frame": 1, "eye": [0, 0, 1], "target": [0, 0, 0], "sensor": 24}]' \
    '[{"frame": 1, "eye": [0, 0, 1], "target": [0, 0, 0], "ortho": 3}, {"frame": 2, "fov": 30}]'; do
    echo "{\"format\": \"meso-camera\", \"version\": 1, \"keys\": $keys}" >wrong.json
    refuse --keys wrong.json vase.meso -o x-%d.png
done
ls x* y* 2>/dev/null
true
