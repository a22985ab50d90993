# Sweeps over seeds: the same lines for any threads, shards and interruptions.
cp "$fixtures/vase.tiles.json" "$fixtures/vase.obj" .
solve() {
    meso-solve -q "$@" vase.tiles.json vase.obj
}

# The checksum is the same in every build, or results depend on it; a better solver changes it.
solve --seeds 1-24 -o all.jsonl
cut -d '"' -f 1-10 all.jsonl | head -n 3
cksum <all.jsonl
for threads in 1 2 7; do
    solve --seeds 1-24 --threads $threads --each "$threads-%d.slots" | cmp - all.jsonl && echo "$threads threads: the same"
done
for seed in 1 13 24; do
    cmp 1-$seed.slots 7-$seed.slots
    meso-info 1-$seed.slots | grep -e '"command"' -e '"seed"'
    solve --seed $seed -o alone.slots
    cmp alone.slots 1-$seed.slots
done
solve --seeds 3x2 --conflicts 9 --each more-%d.slots -o more.jsonl
solve --seed 3 --attempts 2 --conflicts 9 -o - | cmp - more-3.slots
# As typed, the command is one that works.
solve --seeds 3 --provenance full --each full-%d.slots -o more.jsonl
meso-info full-3.slots | grep '"command"'

# Shards in any order, some of them twice, the last line cut off.
for shard in 17-24 1-9 5-16; do solve --seeds $shard; done >shards.jsonl
printf '{"seed":25,"verd' >>shards.jsonl
solve --seeds 1-24 --resume shards.jsonl --progress json -o merged.jsonl 2>&1 | tail -n 1
cmp merged.jsonl all.jsonl && echo "merged: the same"
head -n 20 shards.jsonl >some.jsonl
solve --seeds 1-24 --resume some.jsonl --each again-%d.slots -o merged.jsonl
cmp merged.jsonl all.jsonl && cmp again-20.slots 1-20.slots && echo "resumed: the same"
# What has the name of an assignment and is another, or none, is written again.
cp again-1.slots again-2.slots
echo nothing >again-3.slots
head -c 500 1-4.slots >again-4.slots
rm again-5.slots
solve --seeds 1-24 --resume some.jsonl --each again-%d.slots -o merged.jsonl
for seed in 1 2 3 4 5; do cmp again-$seed.slots 1-$seed.slots; done

# A list, in any order: a part has attempts of its own.
solve --seeds 20-24x20,1-9,19,10-18 | cmp - all.jsonl && echo "a list: the same"
solve --seeds 3x1,1-2 -o parts.jsonl
{ head -n 2 all.jsonl && solve --seeds 3 --attempts 1; } | cmp - parts.jsonl && echo "its parts: the same"
solve --seeds 3,1-2 --resume parts.jsonl 2>&1 >/dev/null || echo "status $?"

# Cut short by a signal: what was solved stays in FILE.partial, and nowhere else.
mkdir cut
env --default-signal=INT meso-solve -q --seeds 1-3000 vase.tiles.json vase.obj -o cut/all.jsonl &
process=$!
tries=0
until [ -s cut/all.jsonl.partial ] || [ $tries -gt 600 ]; do
    sleep 0.05
    tries=$((tries + 1))
done
kill -s INT $process
wait $process 2>/dev/null || echo "status $?"
ls -A cut
solve --seeds 1-3000 -o cut/all.jsonl || echo "status $?"
solve --seeds 1-3000 --resume cut/all.jsonl.partial -o cut/all.jsonl
ls -A cut
solve --seeds 1-3000 >whole.jsonl
cmp whole.jsonl cut/all.jsonl && echo "interrupted: the same"

# The best, also of lines that were there.
meso-solve --seeds 1-24 --resume all.jsonl --best balance=best.slots vase.tiles.json vase.obj -o best.jsonl
meso-info best.slots | grep '"seed"'
meso-solve --seeds 3 --best attempts vase.tiles.json vase.obj >/dev/null
ls ./*.partial 2>/dev/null

# What does not go together.
for wrong in '--seeds 9-3' '--seeds 1-' '--seeds 1-3x0' '--seeds 0-9223372036854775808' '--seeds 1-99999999' \
    '--seeds 1-9,4' '--seeds 1,,2' '--seeds 5,1-2x2 --attempts 2' \
    '--each %d' '--seeds 1-2 --each x' '--seeds 1-2 --seed 3' '--seeds 1-2x2 --attempts 2' '--seeds 1 --best size' \
    '--seeds 1 --report x' '--seeds 1 --json'; do
    # shellcheck disable=SC2086
    meso-solve $wrong vase.tiles.json vase.obj 2>message >/dev/null && echo "accepted: $wrong"
    head -n 1 message
done
sed 's/"seed":3,/"seed":4,/' all.jsonl | solve --seeds 1-4 --resume - 2>&1 >/dev/null
meso-solve -q --attempts 3 --seeds 1-4 --resume all.jsonl vase.tiles.json vase.obj 2>&1 >/dev/null
solve --seeds 1-4 >/dev/full || echo "status $?"
solve --seeds 1-4 -o no/all.jsonl || echo "status $?"
solve --threads 1 --seeds 1-4 --each no/%d.slots || echo "status $?"
