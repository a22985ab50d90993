# What is installed, and that it works from there.
"$scripts/install-files" "${generators%/scripts}" "$(dirname "$(command -v meso-map)")" "$PWD/usr"
(cd usr && find . -type f ! -path './share/man/*' | LC_ALL=C sort)
cd usr/share/meso/examples
for set in *.tiles.json basket.json; do ../../../bin/meso-tile check --strict "$set"; done
for surface in *.obj; do ../../../bin/meso-info "$surface" | grep '"kind"'; done
