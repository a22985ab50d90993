# What the shells' completions offer.
for tool in meso-mesh meso-tile meso-solve meso-suggest meso-map meso-decor meso-quilt meso-grow meso-replicate meso-render meso-check meso-info; do
    "$scripts/make-completion" bash "$(command -v $tool)" >$tool.bash
    for shell in zsh fish; do
        "$scripts/make-completion" $shell "$(command -v $tool)" >$tool.$shell
        if command -v $shell >/dev/null; then $shell -n $tool.$shell; fi
    done
done
mkdir files files/folder.d
cd files
touch a.tiles.json a.json b.obj c.ply 'd e.slots' f.csv g.meso h.png i.jsonl

# The candidates for the last of these words, which are split as bash does.
offer() {
    echo "$* -> $(bash -c 'source "../$1.bash"
        COMP_WORDS=("$@") COMP_CWORD=$(($# - 1))
        "_${1//-/_}"
        printf "%s\n" "${COMPREPLY[@]}"' bash "$@" | LC_ALL=C sort | tr '\n' '|')"
}
offer meso-tile ''
offer meso-tile ch
offer meso-tile import ''
offer meso-tile check --str
offer meso-tile import --str
offer meso-tile -
offer meso-solve --eng
offer meso-solve --engine ''
offer meso-solve --engine = e
offer meso-solve --engine =
offer meso-solve --engine wfc ''
offer meso-solve --seed ''
offer meso-solve a.tiles.json ''
offer meso-solve a.tiles.json b.obj -o ''
offer meso-solve --keep ''
offer meso-solve --keep d
offer meso-solve --orient ''
offer meso-solve --best ''
offer meso-mesh ''
offer meso-mesh weld sub
offer meso-mesh weld b.obj -o ''
offer meso-map a.tiles.json b.obj ''
offer meso-map -q --to
offer meso-map --to g
offer meso-map --mesh-path ''
offer meso-map --json = ''
offer meso-map --json ''
offer meso-render ''
offer meso-check --m
offer meso-check ''
offer meso-check --mark ''
offer meso-info g.meso h.png ''
offer meso-info --slots ''

# For programs, and no part of the help.
meso-info --list-options | grep '^o' | head -n 2 | tr '\t' '|'
meso-info --help | grep -c list-options
true
