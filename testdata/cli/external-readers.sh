# Other programs read what is written here.
cp "$fixtures/vase.meso" .
meso-map -q --divisions 6 vase.meso -o vase.drc
for kind in glb obj stl; do
    meso-map -q --divisions 6 vase.meso -o vase.$kind
done
meso-map -q --divisions 6 --compress draco vase.meso -o draco.glb
meso-map -q --divisions 6 --compress meshopt vase.meso -o meshopt.glb
meso-map -q --divisions 6 --compress meshopt --normal-bits 8 vase.meso -o narrow.glb
meso-map -q --divisions 6 --up z --unit 0.01 vase.meso -o turned.glb
meso-map -q --divisions 6 vase.meso -o vase.ply
meso-render -q --size 160x120 vase.meso -o vase.exr --png vase.png

draco_decoder -i vase.drc -o decoded.ply >/dev/null || echo "draco_decoder: status $?"
for element in vertex face; do
    grep -a "^element $element" decoded.ply >counts && grep -q '[1-9]' counts || echo "no $element in the Draco file"
done
if command -v assimp >tool; then
    for kind in glb obj stl ply; do
        meso-map -q --divisions 3 --section-step 0.2 --json=report vase.meso -o small.$kind
        faces=$(sed -n 's/ *"triangles": \([0-9]*\),.*/\1/p' report)
        assimp info small.$kind | sed -n 's/^Faces: *//p' | grep -qx "$faces" || echo "assimp: not all faces of $kind"
    done
fi
meso-decor -q "$fixtures/eleven-steps.pattern.json" "$fixtures/vase.obj" -o decor.glb
if [ -d "$npm/node_modules/gltf-validator" ]; then
    for file in vase.glb draco.glb meshopt.glb narrow.glb turned.glb decor.glb; do
        NODE_PATH=$npm/node_modules node "$scripts/validate-glb.mjs" $file >said || { echo "validator: $?" && cat said; }
    done
elif [ -n "${CI:-}" ]; then     # elsewhere scripts/setup has said that it could not install it
    echo "gltf-validator is not installed" >&2
fi
exrheader vase.exr | grep -o -e '^ *[A-Za-z.]*, .*sampling' | sed 's/, sampling//'
exrinfo vase.exr >/dev/null || echo "exrinfo: status $?"
oiiotool vase.exr -d float -o copy.tif && oiiotool --info vase.png | sed 's/ *: */: /'

# What the things of a matte cover is, in sum, what is covered.
meso-render -q --size 160x120 --samples 16 --aov all vase.meso -o all.exr
coverage() {
    echo "crypto_$1"00.G,"crypto_$1"00.A,"crypto_$1"01.G,"crypto_$1"01.A,"crypto_$1"02.G,"crypto_$1"02.A
}
for matte in slot tile material; do
    oiiotool all.exr --ch "$(coverage $matte)" --chsum all.exr --ch A --fail 0.002 --diff | grep -E 'PASS|FAIL'
done
exrheader all.exr | grep -c '^cryptomatte/'
exrheader all.exr | grep -o -E '^ *(P|uv|AO|roughness|metallic)[.A-Z]*, .*point'
