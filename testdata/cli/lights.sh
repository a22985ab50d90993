# Environments as light, from nothing and from files; the same bytes for any number of threads; tone curves, of the PNG
# alone; backgrounds of each sort; what does not fit together is refused.
cp "$fixtures"/vase.meso .
small='--size 48x32 --samples 1 --provenance none'

# Maps of one colour as Radiance has them, 16 x 8: grey everywhere, and nothing but light from above.
map() {
    printf '#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 8 +X 16\n'
    for row in 1 2 3 4 5 6 7 8; do
        for column in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16; do
            [ $row -le $1 ] && printf '\200\200\200\200' || printf '\0\0\0\0'
        done
    done
}
map 8 >grey.hdr
map 2 >above.hdr

for light in camera studio sky grey.hdr above.hdr; do
    meso-render $small --light $light --threads 1 vase.meso -o one.exr --png $light.png
done
meso-render $small --light above.hdr --threads 3 vase.meso -o three.exr
cmp one.exr three.exr
meso-render $small vase.meso -o plain.png
cmp plain.png camera.png
meso-render $small --light grey.hdr --light-turn 77 vase.meso -o turned.png
cmp grey.hdr.png turned.png
meso-render $small --light sky --light-turn 77 vase.meso -o turned.png
cmp -s sky.png turned.png && echo "it does not turn"
meso-render $small --light grey.hdr --light-strength 0 --background 0,0,0 vase.meso -o dark.png
meso-render $small --light grey.hdr --background 0,0,0 --tone none vase.meso -o lit.png
cmp -s dark.png lit.png && echo "it does not shine"
meso-render -q --size 48x32 --samples 1 --light above.hdr --light-turn 10 --json vase.meso -o above.png |
    grep -A1 -E '"(role": "light|command": "meso-render)'

# Tones: none but the PNG's.
meso-render $small vase.meso -o usual.exr
for tone in shoulder none neutral agx filmic; do
    meso-render $small --tone $tone --background 0,0,0 vase.meso -o tone.exr --png tone-$tone.png
    cmp usual.exr tone.exr
    [ $tone = shoulder ] || ! cmp -s tone-shoulder.png tone-$tone.png || echo "$tone does nothing"
done

# Backgrounds: a picture of one colour is that colour, whatever its size; the light is where nothing else is.
meso-render $small --eye 0,9,9 --target 0,18,18 --background 1,0,0 --size 7x31 vase.meso -o red.png
meso-render $small --background red.png vase.meso -o behind.png
meso-render $small --background 1,0,0 vase.meso -o given.png
cmp behind.png given.png
meso-render $small --background red.png --tone agx vase.meso -o behind.png
meso-render $small --background 1,0,0 --tone agx vase.meso -o given.png
cmp behind.png given.png
meso-render $small --light grey.hdr --background light --tone none vase.meso -o behind.png
meso-render $small --light grey.hdr --background grey.hdr --tone none vase.meso -o given.png
cmp behind.png given.png
meso-render $small --background usual.exr vase.meso -o behind.png

refuse() {
    status=0
    meso-render $small "$@" vase.meso -o x.png || status=$?
    echo "status $status"
}
refuse --light-turn 20
refuse --background light
refuse --background 1,2,3
refuse --background some.jpg
refuse --background none.png
refuse --tone loud
refuse --light red.png
refuse --light vase.meso
refuse --light usual.exr
head -c 200 grey.hdr >cut.hdr
refuse --light cut.hdr
ls x* 2>/dev/null
true
