# Every 64th byte of an assignment and of a model, and some of a quilt, flipped, and the file cut off there: status 4 and one line.
cp "$testdata/cli/quad.tiles.json" quad.json
"$generators/make_vase" 8 4 >vase.obj
meso-solve -q quad.json vase.obj -o vase.slots
meso-map -q quad.json vase.obj vase.slots -o vase.meso

# Prints the byte at an offset, all bits turned.
turned() {
    printf "\\$(printf '%03o' $((255 - $(od -An -tu1 -j "$2" -N 1 "$1"))))"
}
# Runs a command that must refuse its input.
refused() {
    status=0
    "$@" >said 2>&1 || status=$?
    [ $status = 4 ] && [ "$(wc -l <said)" = 1 ] && [ ! -e out.ply ] ||
        { echo "$what: status $status" && cat said; }
}
check() {
    file=$1
    size=$(wc -c <"$file")
    at=0
    while [ $at -lt "$size" ]; do
        what="$file cut at $at"
        head -c $at "$file" >cut
        refused $2 cut -o out.ply
        what="$file flipped at $at"
        cp "$file" flipped
        turned "$file" $at | dd of=flipped bs=1 seek=$at conv=notrunc status=none
        refused $2 flipped -o out.ply
        at=$((at + $3))
    done
}
check vase.slots "meso-map quad.json vase.obj" 64
check vase.meso meso-map 64
meso-quilt -q --swatch wire --sides 3 --columns 2 --rows 2 --plane 3x3 -o wire.quilt
check wire.quilt meso-map $(($(wc -c <wire.quilt) / 60))
