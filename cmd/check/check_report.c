#include "cmd/check/check_report.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "formats/json/json_text.h"

/* What the count of a fault is of, what its size is, and whether it is wrong wherever it is. */
typedef struct FaultRow {
    const char *of, *size;
    bool plain, space, slots, cages, normals;     /* what it needs to be looked for */
} FaultRow;

static const FaultRow ROWS[MESO_FAULT_COUNT] = {
    [MESO_FAULT_GAP] = {"torn rings between slots", "wide", .slots = true},
    [MESO_FAULT_ANGLE] = {"bent joints between slots", "degrees", .slots = true, .normals = true},
    [MESO_FAULT_OPEN] = {"open rings", NULL, .plain = false},
    [MESO_FAULT_BORDER] = {"of these at borders", NULL, .plain = false, .cages = true},
    [MESO_FAULT_LID] = {"of these at lids", NULL, .plain = false, .cages = true},
    [MESO_FAULT_LEAK] = {"that leak", NULL, .plain = false},
    [MESO_FAULT_T_JOINT] = {"T-joints", NULL, .plain = true},
    [MESO_FAULT_WINDING] = {"edges wound against each other", NULL, .plain = true},
    [MESO_FAULT_INVERTED] = {"triangles wound against their normals", NULL, .plain = true, .normals = true},
    [MESO_FAULT_PINCH] = {"triangles where the surface folds back", NULL, .plain = true, .normals = true},
    [MESO_FAULT_NORMAL] = {"other corners with wrong normals", NULL, .plain = true, .normals = true},
    [MESO_FAULT_INSIDE_OUT] = {"closed pieces inside out", NULL, .plain = true},
    [MESO_FAULT_NUMBER] = {"triangles with what is no number", NULL, .plain = true},
    [MESO_FAULT_FLAT] = {"triangles without area", NULL, .plain = true},
    [MESO_FAULT_DOUBLE] = {"triangles that are there before", NULL, .plain = true},
    [MESO_FAULT_BRANCH] = {"edges where sections are shared", NULL, .plain = true, .slots = true},
    [MESO_FAULT_EDGE] = {"edges of over two triangles", NULL, .plain = true},
    [MESO_FAULT_VERTEX] = {"places where fans touch", NULL, .plain = true},
    [MESO_FAULT_FOLD] = {"folded slots", NULL, .plain = true, .cages = true},
    [MESO_FAULT_CROSSING] = {"pairs that cross", "deep", .space = true},
    [MESO_FAULT_SELF_CROSSING] = {"pairs of triangles of one thing that cross", "deep", .space = true},
    [MESO_FAULT_THIN] = {"places over what is too thin", "thick", .space = true},
    [MESO_FAULT_FLOATING] = {"pieces that float", NULL, .plain = false},
};

/* Whether it was looked for. */
static bool is_known(const MesoCheckFindings *findings, MesoFault fault)
{
    const FaultRow *row = &ROWS[fault];
    const MesoInspectedMesh *mesh = &findings->input->mesh;
    return !(row->space && findings->bounds->fast) && !(row->slots && !mesh->slots) &&
           !(row->cages && !mesh->cage_count) && !(row->normals && !mesh->normals);
}

/* ---- where ---- */

static json_t *point_of(MesoVec3 p)
{
    return json_pack("[ooo]", meso_json_shortest(p.x), meso_json_shortest(p.y), meso_json_shortest(p.z));
}

static void put_place(json_t *object, const MesoCheckFindings *findings, const MesoFinding *finding)
{
    const MesoCheckInput *input = findings->input;
    char room[24];
    if (finding->cage != MESO_NO_INDEX)
        json_object_set_new(object, "slot", json_integer(finding->cage));
    uint32_t t = finding->triangle;
    if (t == MESO_NO_INDEX)
        return;
    MesoVec3 middle = meso_inspected_middle(&input->mesh, t);
    if (input->faces)
        json_object_set_new(object, "face", json_integer((json_int_t)input->faces[t] + 1));
    if (input->mesh.slots)
        json_object_set_new(object, "slot", json_integer(input->mesh.slots[t]));
    if (input->mesh.things)
        json_object_set_new(object, input->thing,
                            meso_json_string(meso_check_thing_name(input, input->mesh.things[t], room)));
    if (meso_vec3_finite(middle))
        json_object_set_new(object, "at", point_of(middle));
}

static void print_place(const MesoCheckFindings *findings, const MesoFinding *finding)
{
    const MesoCheckInput *input = findings->input;
    char room[24];
    if (finding->cage != MESO_NO_INDEX)
        printf(": slot %u", finding->cage);
    uint32_t t = finding->triangle;
    if (t == MESO_NO_INDEX)
        return;
    MesoVec3 middle = meso_inspected_middle(&input->mesh, t);
    printf(": ");
    if (input->faces)
        printf("face %" PRIu64 ", ", (uint64_t)input->faces[t] + 1);
    if (input->mesh.slots)
        printf("slot %u, ", input->mesh.slots[t]);
    if (input->mesh.things)
        printf("%s %s, ", input->thing, meso_check_thing_name(input, input->mesh.things[t], room));
    printf("at %.5g %.5g %.5g", (double)middle.x, (double)middle.y, (double)middle.z);
}

/* ---- JSON ---- */

static json_t *fault_json(const MesoCheckFindings *findings, MesoFault fault)
{
    const MesoFinding *finding = &findings->inspection->findings[fault];
    if (!is_known(findings, fault))
        return json_null();
    json_t *object = json_pack("{sI}", "count", (json_int_t)finding->count);
    if (ROWS[fault].size)
        json_object_set_new(object, ROWS[fault].size, meso_json_shortest((float)finding->worst));
    put_place(object, findings, finding);
    return object;
}

static json_t *pairs_json(const MesoCheckFindings *findings)
{
    json_t *list = json_array();
    for (uint32_t i = 0; i < findings->inspection->pair_count; i++) {
        const MesoCrossingPair *pair = &findings->inspection->pairs[i];
        char a[24], b[24];
        json_array_append_new(list, json_pack(
            "{s[oo]sIsoso}", "things", meso_json_string(meso_check_thing_name(findings->input, pair->a, a)),
            meso_json_string(meso_check_thing_name(findings->input, pair->b, b)), "triangles",
            (json_int_t)pair->triangle_pairs, "deep", meso_json_shortest((float)pair->depth), "at",
            point_of(meso_inspected_middle(&findings->input->mesh, pair->triangle))));
    }
    return list;
}

static json_t *sizes_json(const MesoCheckFindings *findings)
{
    const MesoCheckInput *input = findings->input;
    const MesoInspection *found = findings->inspection;
    json_t *sizes = json_pack("{sIsIsIsIsIsIsI}", "vertices", (json_int_t)input->mesh.vertex_count, "places",
                              (json_int_t)found->vertex_count, "faces", (json_int_t)input->face_count, "triangles",
                              (json_int_t)input->mesh.triangle_count, "pieces", (json_int_t)found->piece_count,
                              "open_edges", (json_int_t)found->open_edges, "looped_faces", (json_int_t)input->looped);
    const struct {
        const char *name;
        double value;
    } numbers[] = {{"area", found->area}, {"volume", found->volume}, {"shortest_edge", found->shortest_edge},
                   {"mean_edge", found->mean_edge}, {"longest_edge", found->longest_edge}};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        json_object_set_new(sizes, numbers[i].name, meso_json_shortest((float)numbers[i].value));
    if (found->box.low.x <= found->box.high.x) {
        json_object_set_new(sizes, "low", point_of(found->box.low));
        json_object_set_new(sizes, "high", point_of(found->box.high));
    }
    if (input->edge > 0)
        json_object_set_new(sizes, "surface_edge", meso_json_shortest(input->edge));
    return sizes;
}

json_t *meso_check_json(const MesoCheckFindings *findings)
{
    const MesoInspection *found = findings->inspection;
    json_t *faults = json_object(), *root = json_object();
    for (uint32_t f = 0; f < MESO_FAULT_COUNT; f++)
        json_object_set_new(faults, MESO_FAULT_NAMES[f], fault_json(findings, (MesoFault)f));
    int failed = json_object_set_new(root, "sizes", sizes_json(findings));
    failed |= json_object_set_new(root, "watertight", json_pack("{sssIsI}", "by", findings->input->thing, "count",
                                                                (json_int_t)found->thing_count, "closed",
                                                                (json_int_t)found->closed_count));
    if (findings->input->mesh.slots)
        failed |= json_object_set_new(root, "joints", json_integer((json_int_t)found->slot_joints));
    if (!findings->bounds->fast)
        failed |= json_object_set_new(root, "thickness", json_pack(
            "{soso}", "thinnest", meso_json_shortest((float)found->thinnest), "usual",
            meso_json_shortest((float)found->usual_thickness)));
    failed |= json_object_set_new(root, "faults", faults);
    failed |= json_object_set_new(root, "crossing_pairs", findings->bounds->fast ? json_null() : pairs_json(findings));
    if (!failed)
        return root;
    json_decref(root);
    return NULL;
}

/* ---- lines ---- */

static void print_sizes(const MesoCheckFindings *findings)
{
    const MesoInspection *found = findings->inspection;
    const MesoBox *box = &found->box;
    printf("%-14s %" PRIu64 " faces, %u triangles, %u places, %u piece%s, %.5g x %.5g x %.5g, area %.5g, volume %.5g",
           "sizes", findings->input->face_count, findings->input->mesh.triangle_count, found->vertex_count,
           found->piece_count, found->piece_count == 1 ? "" : "s", (double)box->high.x - (double)box->low.x,
           (double)box->high.y - (double)box->low.y, (double)box->high.z - (double)box->low.z, found->area,
           found->volume);
    if (findings->input->edge > 0)
        printf(", over edges of %.5g", (double)findings->input->edge);
    printf("\n");
}

static void print_fault(const MesoCheckFindings *findings, MesoFault fault)
{
    const MesoInspection *found = findings->inspection;
    const MesoFinding *finding = &found->findings[fault];
    printf("%-14s ", MESO_FAULT_NAMES[fault]);
    if (!is_known(findings, fault)) {
        printf("not looked for\n");
        return;
    }
    printf("%" PRIu64, finding->count);
    if (fault == MESO_FAULT_LEAK)
        printf(" of %u %ss", found->thing_count, findings->input->thing);
    printf(" %s", ROWS[fault].of);
    if (ROWS[fault].size && finding->triangle != MESO_NO_INDEX)
        printf(", %.5g %s", finding->worst, ROWS[fault].size);
    if (fault == MESO_FAULT_THIN && found->usual_thickness > 0)
        printf(" (usual %.5g)", found->usual_thickness);
    print_place(findings, finding);
    printf("\n");
}

MesoStatus meso_check_print(const MesoCheckFindings *findings, MesoError *error)
{
    print_sizes(findings);
    for (uint32_t f = 0; f < MESO_FAULT_COUNT; f++)
        print_fault(findings, (MesoFault)f);
    if (fflush(stdout) != 0 || ferror(stdout))
        return meso_fail(error, MESO_ERR_OUTPUT, "cannot write to standard output");
    return MESO_OK;
}

/* ---- bounds ---- */

typedef struct Verdict {
    char text[400];
    uint32_t count;
} Verdict;

static void exceed(Verdict *verdict, const char *name, double value, const char *limit, double bound)
{
    size_t used = strlen(verdict->text);
    snprintf(verdict->text + used, sizeof verdict->text - used, "%s%s %.6g (%s %.6g)", verdict->count ? ", " : "", name,
             value, limit, bound);
    verdict->count++;
}

/* A bound of what cannot be looked for must not seem to hold. */
static MesoStatus check_known(const MesoCheckFindings *findings, MesoError *error)
{
    const MesoInspectedMesh *mesh = &findings->input->mesh;
    const MesoCheckBounds *bounds = findings->bounds;
    if ((bounds->given.gap || bounds->given.angle) && !mesh->slots)
        return meso_fail(error, MESO_ERR_INPUT, "no slots are in it, which --max-%s is about",
                         bounds->given.gap ? "gap" : "angle");
    if (bounds->given.angle && !mesh->normals)
        return meso_fail(error, MESO_ERR_INPUT, "no normals are in it, which --max-angle is about");
    return MESO_OK;
}

MesoStatus meso_check_judge(const MesoCheckFindings *findings, MesoError *error)
{
    const MesoCheckBounds *bounds = findings->bounds;
    const MesoInspection *found = findings->inspection;
    const MesoFinding *f = found->findings;
    const double depth = fmax(f[MESO_FAULT_CROSSING].worst, f[MESO_FAULT_SELF_CROSSING].worst);
    uint64_t crossings = f[MESO_FAULT_CROSSING].count + f[MESO_FAULT_SELF_CROSSING].count;
    double faults = findings->input->looped;
    Verdict verdict = {.count = 0};
    if (check_known(findings, error))
        return error->status;
    for (uint32_t i = 0; i < MESO_FAULT_COUNT; i++)
        faults += ROWS[i].plain ? (double)f[i].count : 0;
    const struct {
        bool given;
        const char *name;
        double value, bound;
    } most[] = {
        {true, "faults", faults, bounds->faults},
        {bounds->given.gap, "gap", f[MESO_FAULT_GAP].worst, (double)bounds->gap},
        {bounds->given.angle, "angle", f[MESO_FAULT_ANGLE].worst, (double)bounds->angle},
        {bounds->given.open, "open", (double)f[MESO_FAULT_OPEN].count, bounds->open},
        {bounds->given.crossings, "crossings", (double)crossings, bounds->crossings},
        {bounds->given.depth, "depth", depth, (double)bounds->depth},
        {bounds->given.floating, "floating", (double)f[MESO_FAULT_FLOATING].count, bounds->floating},
    };
    for (size_t i = 0; i < sizeof most / sizeof *most; i++)
        if (most[i].given && most[i].value > most[i].bound)
            exceed(&verdict, most[i].name, most[i].value, "at most", most[i].bound);
    if (bounds->given.thickness && found->thinnest > 0 && found->thinnest < (double)bounds->thickness)
        exceed(&verdict, "thickness", found->thinnest, "at least", (double)bounds->thickness);
    return verdict.count ? meso_fail(error, MESO_ERR_NO, "%s", verdict.text) : MESO_OK;
}
