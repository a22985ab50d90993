# The check of includes finds what runs against the order: upwards, sideways, into tests, in circles.
mkdir -p libcore/base libcore/tiling/search libcore/tiling/proof formats/file cmd
echo '#include "libcore/base/good.h"' >formats/file/good.c
"$scripts/check-includes" "$PWD" || exit 1
echo '#include "libcore/tiling/search/search.h"' >libcore/base/up.c
echo '#include "libcore/tiling/search/search.h"' >libcore/tiling/proof/beside.c
echo '#include "formats/file/input.h"' >libcore/tiling/search/out.h
echo '#include "libcore/base/b.h"' >libcore/base/a.h
echo '#include "libcore/base/a.h"' >libcore/base/b.c
echo '#include "libcore/base/a_fixture.h"' >libcore/base/uses.c
mkdir libcore/attic
echo '#include "libcore/base/good.h"' >libcore/attic/old.c
"$scripts/check-includes" "$PWD"
