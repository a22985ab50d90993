# Pictures under little memory: the right bytes, or one line and status 33. Nothing else, and nothing left behind.
cp "$fixtures/vase.meso" .
meso-render -q --visibility tiles --threads 2 --size 160x120 vase.meso -o x.png
mv x.png plain.png

# try KIND MEGABYTES: under that limit, of v (addresses) or d (data).
try() (
    ulimit -c 0
    ulimit "-$1" $((1024 * $2))
    # Where the libraries do not fit, or a sanitizer's own memory, there is no tool.
    meso-render --version >/dev/null 2>&1 || exit 0
    status=0
    timeout 60 meso-render -q --visibility tiles --threads 2 --size 160x120 vase.meso -o x.png 2>said || status=$?
    case $status in
    0) cmp plain.png x.png ;;
    33) [ "$(wc -l <said)" = 1 ] && grep -q memory said && [ ! -e x.png ] ;;
    *) false ;;
    esac || echo "ulimit -$1, $2 MB: status $status, $(head -n 1 said)"
    rm -f x.png said
)
for megabytes in 150 180 200 220 240 280 320 360 400 450 500 560; do try v $megabytes; done
for megabytes in 30 60 90 120; do try d $megabytes; done
ls -A
