# Every tool has help and a version on standard output, and knows wrong usage.
for tool in meso-mesh meso-tile meso-solve meso-suggest meso-map meso-decor meso-quilt meso-grow meso-replicate meso-render meso-check meso-info; do
    $tool --help >help.txt || echo "$tool --help: status $?"
    grep -q '^Usage:' help.txt || echo "$tool --help: no usage"
    awk -v tool=$tool 'length > 80 { print tool " --help: over 80 columns: " $0 }' help.txt
    $tool -h | cmp - help.txt
    $tool --version
    $tool --no-such-option; echo "$tool: status $?"
done
