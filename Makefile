# meso: make [config=release|debug|sanitize|coverage|fuzz] TARGET
#
#   all               the tools, to build/bin (release) or build/CONFIG/bin
#   examples          tile sets and surfaces to try, to build/examples
#   check             every test: units, folder pages, the order of includes, man pages, command lines
#   check-exhaustive  $(CHECK_PATTERNS) random patterns on each of 12 surfaces; growth over $(CHECK_MESHES) broken
#                     meshes; the solver against brute force on all gluings of up to $(CHECK_SLOTS) slots, for
#                     $(CHECK_SECONDS) seconds at most: a line for each number of slots and core
#   check-patterns    the random patterns alone
#   check-growth      growth over $(CHECK_MESHES) broken meshes alone
#   check-reference   comparison with the prototype's published data in $(DATA)
#   check-pairs       what meso-check says of the models of all pairs in $(DATA): a table
#   check-readers     meshes opened by Blender, assimp and TinyUSDZ, where they are: counts and bounds
#   bench             rates of every stage, beside the prototype's
#   bench-solve       the solver alone: pairs, growth, many seeds, random tile sets on a torus, and every
#                     combination of the data's surfaces and tile sets
#   bench-map         times, sizes and memory of meshes by pair and format, beside the prototype's and what is to be
#   bench-render      times of drawing by stage, and memory, beside the prototype's
#   bench-cycles      the vase beside Blender's Cycles: seconds and noise; ten minutes
#   bench-decor       distances on surfaces, and their errors; lines, cells, samples, cuts; an editing sequence
#   bench-exact       a table of the engines' times, memory and errors against exact distances: four minutes
#   bench-quilt       the paper's Table 1 again, with swatches and surfaces of ours, and how good each quilt is
#   bench-grow        walks over surfaces and marches through textures: rates and errors; growth with its geometry;
#                     with MILLIONS=10 so many million terminals, too: minutes, and gigabytes
#   bench-replicate   details on a patch that is stretched, beside the paper's Table 1; times
#   demo              pictures and meshes of a woven vase and a teapot, to build/demo
#   quilts            ten pictures of quilts, to build/quilts
#   gallery           ten pictures of ten structures, by all methods, to build/gallery
#   details           three strips of details that replicate, to build/details
#   fuzz-run          with config=fuzz: each reader for $(FUZZ_SECONDS) seconds
#   install           to $(DESTDIR)$(PREFIX)
#   clean

config ?= release
PREFIX ?= /usr/local
DATA   ?= ../shared/data/mesogen
FUZZ_SECONDS ?= 60
CHECK_PATTERNS ?= 84
CHECK_MESHES ?= 10000
CHECK_SLOTS ?= 6
CHECK_SECONDS ?= 7200
BUILD  ?= build
WERROR ?= $(if $(CI),-Werror)

OUT := $(BUILD)/$(config)
BIN := $(if $(filter release,$(config)),$(BUILD)/bin,$(OUT)/bin)

CC  := gcc
CXX := g++
FLAGS_release  := -O3 -g1
FLAGS_debug    := -O0 -g
FLAGS_sanitize := -O1 -g1 -fno-omit-frame-pointer -fsanitize=address,undefined -fno-sanitize-recover=all
FLAGS_coverage := -O0 -g --coverage
FLAGS_fuzz     := -O1 -g -fno-omit-frame-pointer -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all
LINK_release   := -Wl,-O1
# Some 250 programs of 30 MB: gold takes half as long.
LINK_sanitize  := -fsanitize=address,undefined $(if $(shell command -v ld.gold),-fuse-ld=gold)
LINK_coverage  := --coverage
LINK_fuzz      := -fsanitize=address,undefined
ifeq ($(config),fuzz)
CC  := clang
CXX := clang++
endif
ifeq ($(filter $(config),release debug sanitize coverage fuzz),)
$(error config=$(config) is not one of release, debug, sanitize, coverage, fuzz)
endif

# The same bytes everywhere: no contraction, no reassociation; errno and traps are not looked at.
FLOATS   := -ffp-contract=off -fno-math-errno -fno-trapping-math
PACKAGES := draco libpng libdeflate libisal libxxhash jansson openmesh polyclipping zlib
# psabi: how vectors are handed over, which are only handed to what is inlined (lanes.h).
WARN     := -Wall -Wextra -Wconversion -Wshadow -Wno-psabi $(WERROR)
CPPFLAGS := -I. -D_POSIX_C_SOURCE=200809L -MMD -MP $(shell pkg-config --cflags-only-I osmesa $(PACKAGES) 2>/dev/null)
CFLAGS   := -std=c17 $(FLAGS_$(config)) $(FLOATS) -pthread $(WARN)
CXXFLAGS := -std=c++17 $(FLAGS_$(config)) $(FLOATS) -pthread $(WARN)
LDFLAGS  := $(LINK_$(config)) -pthread -Wl,--as-needed
LDLIBS   := -lOpenMeshCore -lOpenMeshTools -ltinygltf -ldraco -lmeshoptimizer -lpolyclipping -ldl \
            -lOpenEXRCore-3_1 -lpng -lz -ldeflate -lisal -ljansson -lxxhash -lcadical -lm

SOURCES := $(sort $(shell find libcore formats cmd scripts -name '*.c' -o -name '*.cpp'))
APART   := %_test.c %_bench.c %_fuzz.c %_reference.c cmd/meso-%.c scripts/%
LIBRARY := $(filter-out $(APART),$(SOURCES))
TOOLS   := $(patsubst cmd/%.c,%,$(filter cmd/meso-%,$(SOURCES)))
TESTS   := $(patsubst %.c,%,$(filter %_test.c,$(SOURCES)))
BENCHES := $(patsubst %.c,%,$(filter %_bench.c,$(SOURCES)))
FUZZERS := $(patsubst %.c,%,$(filter %_fuzz.c,$(SOURCES)))
REFERENCES := $(patsubst %.c,%,$(filter %_reference.c,$(SOURCES)))
GENERATORS := make_vase make_teapot make_torus_knot make_mask make_column make_body make_scenery make_clip
SHADERS := $(wildcard shaders/*.glsl)

# Each archive may call those behind it and none before it: the linker goes through them once.
LIBS := $(OUT)/cmd.a $(OUT)/formats.a $(OUT)/libcore.a

all: $(TOOLS:%=$(BIN)/%)

$(OUT)/obj/%.c.o: %.c
	@mkdir -p $(@D)
	$(CC) $(CPPFLAGS) $(CFLAGS) -c $< -o $@
$(OUT)/obj/%.cpp.o: %.cpp
	@mkdir -p $(@D)
	$(CXX) $(CPPFLAGS) $(CXXFLAGS) -c $< -o $@

# $(call embed,NAME,FILE) writes a text as the string NAME.
embed = echo "extern const char $(1)[];"; echo "const char $(1)[] ="; \
        sed 's/\\/\\\\/g; s/"/\\"/g; s/^/    "/; s/$$/\\n"/' $(2); echo "    \"\";"

# Each shaders/NAME.glsl becomes the string meso_shader_NAME.
$(OUT)/shaders.c: $(SHADERS) Makefile
	@mkdir -p $(@D)
	@{ for f in $(SHADERS); do n=$$(basename $$f .glsl | tr -- '-.' '__'); \
	     $(call embed,meso_shader_$$n,$$f); done; \
	   echo "extern int meso_shaders_embedded; int meso_shaders_embedded = 1;"; } > $@
$(OUT)/builtin_macros.c: formats/decor/macros.json Makefile
	@mkdir -p $(@D)
	@{ $(call embed,meso_builtin_macros,$<); } > $@
$(OUT)/obj/%.o: $(OUT)/%.c
	@mkdir -p $(@D)
	$(CC) $(CPPFLAGS) $(CFLAGS) -c $< -o $@

objects = $(patsubst %,$(OUT)/obj/%.o,$(filter $(1)/%,$(LIBRARY)))
$(OUT)/cmd.a: $(call objects,cmd)
$(OUT)/formats.a: $(call objects,formats) $(OUT)/obj/builtin_macros.o
$(OUT)/libcore.a: $(call objects,libcore) $(OUT)/obj/shaders.o
# Changes with the list of sources: make takes an archive that is newer than a new source for one that holds it.
$(OUT)/sources: FORCE
	@mkdir -p $(@D)
	@echo '$(LIBRARY)' | cmp -s - $@ || echo '$(LIBRARY)' >$@
.PHONY: FORCE
$(LIBS): $(OUT)/sources
	@rm -f $@
	ar rcs $@ $(filter %.o,$^)

link = $(CXX) $(LDFLAGS) -o $@ $(filter %.o,$^) $(LIBS) $(LDLIBS)
$(BIN)/%: $(OUT)/obj/cmd/%.c.o $(LIBS)
	@mkdir -p $(@D)
	$(link)
$(OUT)/test/%: $(OUT)/obj/%.c.o $(LIBS)
	@mkdir -p $(@D)
	$(link)
$(OUT)/fuzz/%: $(OUT)/obj/%.c.o $(LIBS)
	@mkdir -p $(@D)
	$(link) -fsanitize=fuzzer

$(GENERATORS:%=$(OUT)/scripts/%): $(OUT)/scripts/%: $(OUT)/obj/scripts/%.c.o $(OUT)/obj/scripts/quad_obj.c.o
	@mkdir -p $(@D)
	$(CC) $(LDFLAGS) -o $@ $^ -lm

$(OUT)/scripts/make_strip: $(OUT)/obj/scripts/make_strip.c.o
	@mkdir -p $(@D)
	$(CC) $(LDFLAGS) -o $@ $^ -lpng

$(OUT)/scripts/check_drat: $(OUT)/obj/scripts/check_drat.c.o
	@mkdir -p $(@D)
	$(CC) $(LDFLAGS) -o $@ $^

# Without sanitizers, which have allocations of their own.
$(OUT)/scripts/fail_malloc.so: scripts/fail_malloc.c
	@mkdir -p $(@D)
	$(CC) -I. -D_POSIX_C_SOURCE=200809L -std=c17 -O2 $(WARN) -fPIC -shared -o $@ $<

generators: $(GENERATORS:%=$(OUT)/scripts/%) $(OUT)/scripts/check_drat $(OUT)/scripts/fail_malloc.so
tests: $(TESTS:%=$(OUT)/test/%) generators
fuzzers: $(FUZZERS:%=$(OUT)/fuzz/%)
benches: $(BENCHES:%=$(OUT)/test/%)
references: $(REFERENCES:%=$(OUT)/test/%)

# What is the same however it is built is looked at once.
PAGES := $(if $(filter sanitize,$(config)),,folders includes man)
check: all tests
	@scripts/run-tests $(OUT) $(BIN) $(TESTS:%=unit:%) $(PAGES) cli
check-unit: tests
	@scripts/run-tests $(OUT) $(BIN) $(TESTS:%=unit:%)
check-cli: all tests
	@scripts/run-tests $(OUT) $(BIN) man cli
check-exhaustive: check-patterns check-growth $(OUT)/test/libcore/tiling/solve/small_graphs_test
	@n=$$(nproc) && seq 0 $$((n - 1)) | \
	    xargs -P $$n -I PART nice $(lastword $^) $(CHECK_SLOTS) $(CHECK_SECONDS) PART $$n
check-patterns: $(OUT)/test/libcore/decor/decor_test
	@nice $< $(CHECK_PATTERNS)
check-growth: $(OUT)/test/libcore/growth/engine/growth_test
	@nice $< $(CHECK_MESHES)
check-reference: all references
	@scripts/check-reference $(OUT) $(BIN) $(DATA) $(REFERENCES)
check-pairs: all
	@scripts/check-pairs $(BIN) $(DATA)
check-readers: all generators
	@scripts/check-readers $(OUT) $(BIN)
bench: all benches generators
	@scripts/bench/stages $(OUT) $(BIN) $(DATA) $(BENCHES)
bench-solve: all benches generators
	@scripts/bench/solve $(OUT) $(BIN) $(DATA)
bench-map: all $(addprefix $(OUT)/test/scripts/bench/map_,bound_bench error_bench)
	@scripts/bench/map $(OUT) $(BIN) $(DATA)
bench-render: all generators
	@scripts/bench/render $(OUT) $(BIN) $(DATA)
bench-cycles: all generators
	@scripts/bench/cycles $(OUT) $(BIN)
bench-decor: $(addprefix $(OUT)/test/libcore/,geodesic/geodesic_bench geodesic/geodesic_lines_bench \
             mesh/cut/mesh_cut_bench decor/decor_bench)
	@for bench in $^; do $$bench; done
bench-quilt: $(OUT)/test/libcore/quilt/check/quilt_bench
	@$< --check
bench-grow: $(addprefix $(OUT)/test/libcore/,geodesic/transport/straight_walk_bench growth/march/texture_march_bench \
            growth/scene/growth_scene_bench)
	@for bench in $(filter-out %growth_scene_bench,$^); do $$bench; done
	@$(filter %growth_scene_bench,$^) $(MILLIONS)
bench-replicate: $(OUT)/test/libcore/replicate/plan/replicate_bench
	@$<
bench-exact: $(OUT)/test/libcore/geodesic/geodesic_bench
	@$< --exact
demo: all generators
	@scripts/make-demo $(OUT) $(BIN) $(BUILD)/demo
quilts: all generators
	@scripts/make-quilts $(OUT) $(BIN) $(BUILD)/quilts
gallery: all generators
	@scripts/make-gallery $(OUT) $(BIN) $(BUILD)/gallery
details: all generators $(OUT)/scripts/make_strip
	@scripts/make-details $(OUT) $(BIN) $(BUILD)/details
fuzz-run: fuzzers all generators
	@scripts/run-fuzzers $(OUT) $(BIN) $(FUZZ_SECONDS) $(FUZZERS)

examples: generators
	@scripts/make-examples $(OUT) $(BUILD)/examples

install: all generators
	@scripts/install-files $(OUT) $(BIN) "$(DESTDIR)$(PREFIX)"

clean:
	rm -rf $(BUILD)

.PHONY: all examples tests generators check check-unit check-cli check-exhaustive check-patterns check-growth \
        check-reference check-pairs check-readers bench bench-solve bench-map bench-render bench-cycles bench-decor \
        bench-quilt bench-grow bench-replicate bench-exact demo quilts gallery details fuzz-run fuzzers benches \
        references install clean
.SECONDARY:
-include $(shell find $(OUT)/obj -name '*.d' 2>/dev/null)
