# Meshes in place of a model: written as every kind, drawn, with their colours and ids; and what is refused.
cp "$fixtures"/vase.* .
cat >house.ply <<PLY
ply
format ascii 1.0
element vertex 6
property float x
property float y
property float z
property uchar red
property uchar green
property uchar blue
element face 3
property list uchar int vertex_indices
property int region
end_header
0 0 0 255 0 0
2 0 0 255 0 0
2 1 0 0 255 0
0 1 0 0 255 0
1 2 0 0 0 255
3 1 1 0 0 255
5 0 1 2 4 3 4
3 1 5 2 4
3 2 5 4 7
PLY
json() {
    grep -E '^  "(regions|slots|tiles|parts|bodies|materials|vertices|faces|triangles|covered_pixels)"' "$1"
}
for kind in ply obj glb drc meso; do
    meso-map -q --json=report --threads 2 house.ply -o x.$kind
    json report
done
grep -v '^# provenance\|^mtllib' x.obj
meso-info x.meso >facts
json facts
meso-map -q x.meso -o y.obj
grep -v '^# provenance\|^mtllib' x.obj >x.plain
grep -v '^# provenance\|^mtllib' y.obj | cmp - x.plain

# A mesh of ours gives itself back, vertex by vertex.
meso-map -q --divisions 4 --section-step 0.2 vase.meso -o vase.ply
meso-map -q --json=report vase.ply -o again.ply
json report
meso-map -q --json=before --divisions 4 --section-step 0.2 vase.meso -o vase.ply
json before

# Drawn: as many pixels as the same from the model, and from a mesh of the mesh.
for from in house.ply x.meso x.obj; do
    meso-render -q --json=report --size 80x60 $from -o x.png
    json report
done
meso-render -q --size 80x60 house.ply -o x.exr
exrheader x.exr | grep -E '^    (region|slot)|meso:' | cut -c 1-30

refuse() {
    status=0
    "$@" 2>err >out || status=$?
    echo "$status $(head -n 1 err)"
}
refuse meso-map --divisions 4 house.ply -o z.ply
refuse meso-map --offset 0.1 x.meso -o z.ply
sed 's/^3 2 5 4 7/3 2 5 9 7/' house.ply >wrong.ply
refuse meso-map wrong.ply -o z.obj
refuse meso-render wrong.ply -o z.png
sed 's/^3 2 5 4 7/3 2 5 4 -7/' house.ply >wrong.ply
refuse meso-render wrong.ply -o z.png
refuse meso-render x.drc -o z.png
ls z* 2>/dev/null
true
