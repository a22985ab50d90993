# glTF of other programs: buffers beside the file, several materials, what is refused; and what comes back of our own.
cp "$fixtures"/vase.* .
mkdir part
# The corners of a square, then 0 1 2 0 2 3.
printf '\0\0\0\0\0\0\0\0\0\0\0\0\0\0\200\077\0\0\0\0\0\0\0\0' >'part/a b.bin'
printf '\0\0\200\077\0\0\200\077\0\0\0\0\0\0\0\0\0\0\200\077\0\0\0\0' >>'part/a b.bin'
printf '\0\0\1\0\2\0\0\0\2\0\3\0' >>'part/a b.bin'

# gltf URI PRIMITIVES
gltf() {
    cat <<END
{"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
 "meshes": [{"primitives": [$2]}],
 "materials": [{"name": "red", "pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 1], "metallicFactor": 0}},
               {"pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0.5, 1], "roughnessFactor": 0.25}}],
 "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
               {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
               {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}],
 "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
 "buffers": [{"uri": "$1", "byteLength": 60}]}
END
}
square='{"attributes": {"POSITION": 0}, "indices": 2, "material": 0}'
triangle='{"attributes": {"POSITION": 1}, "material": 1}'

gltf part/a%20b.bin "$square, $triangle" >two.gltf
meso-mesh info two.gltf | grep -E '"(vertices|faces|name)"'
meso-mesh convert two.gltf -o two.glb
# Materials of a .glb: their colours, then their names.
materials() {
    strings -n 100 "$1" | head -n 1 | sed 's/.*"materials":\[//; s/\],"meshes".*//' | tr '{}' '\n\n' | grep -E 'Factor|name'
}
materials two.glb >materials
cat materials
meso-mesh convert two.glb -o again.glb
materials again.glb | diff - materials && echo "the same materials"
meso-render -q --size 40x30 two.gltf -o two.png --json | sed -n '/"inputs"/,/]/p' | grep -oE '"(role|name)": "[a-z .]*"'
meso-render -q --size 40x30 two.glb -o two.png && echo drawn

gltf 'part/a%20b.bin' "$square" >square.gltf
meso-mesh pair square.gltf -o square.obj && grep -v '^#' square.obj
meso-solve -q --quads-from-triangles vase.tiles.json square.gltf -o square.slots || echo "$?"

refused() {
    gltf "$1" "$2" >refused.gltf
    meso-mesh info refused.gltf || echo "$?"
}
refused part/none.bin "$square"
refused ../part/none.bin "$square"
refused /etc/passwd "$square"
refused part/a%20b.bin '{"attributes": {"POSITION": 0}, "mode": 0}'
refused part/a%20b.bin '{"attributes": {"POSITION": 0}, "mode": 3}'
sed 's/"buffers": \[\(.*\)\]/"buffers": [\1, \1]/' square.gltf >refused.gltf
meso-mesh info refused.gltf || echo "$?"
sed 's/"count": 4/"count": 400000000000/' square.gltf >refused.gltf
meso-mesh info refused.gltf || echo "$?"
cp 'part/a b.bin' a.ply
gltf a.ply "$square" >over.gltf
meso-mesh convert over.gltf -o a.ply || echo "$?"

# Our own: names of tiles, and materials.
meso-map -q --divisions 2 --section-step 0.5 vase.meso -o vase.glb
for kind in glb ply drc; do
    meso-map -q vase.glb -o again.$kind
done
materials vase.glb >materials
materials again.glb | diff - materials && echo "the same materials"
strings again.ply | grep -c '^comment tile'
meso-mesh info again.drc | grep '"tile"'
meso-map -q again.ply -o named.glb
materials named.glb | grep -o '"name":[^,]*' >named
grep -o '"name":[^,]*' materials | diff - named && echo "the same names through PLY"
meso-mesh -q convert vase.glb -o again.ply
meso-map -q again.ply -o again.glb
materials again.glb | diff - materials && echo "the same materials through PLY"
