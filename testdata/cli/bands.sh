# Pictures that come in bands of rows have the bytes of the whole, whatever the bands' height; also by way of standard
# output, and where a band has half of a tile's rows.
render() { meso-render -q --visibility tiles --size 40x90 "$@" "$fixtures/vase.meso"; }
for samples in 1 4; do
    render --samples $samples --aov all --ground shadow -o p.exr --png p.png
    mv p.exr whole.exr
    mv p.png whole.png
    for rows in 16 80; do
        render --samples $samples --aov all --ground shadow --band-rows $rows -o p.exr --png p.png
        cmp p.exr whole.exr
        cmp p.png whole.png
    done
done
render --samples 1 --background none --to png -o - >whole.png
render --samples 1 --background none --to png --band-rows 32 -o - >bands.png
cmp bands.png whole.png

# Of two files that cannot both be written none appears.
render --samples 1 --band-rows 16 -o none.exr --png no/where.png
echo "status $?"
ls none.exr 2>/dev/null
true
