#include "libcore/decor/border_chains.h"
#include "libcore/decor/operators.h"
#include "libcore/geodesic/streamline.h"

/* Chains of the first spec of a set that is a border, or a part of one. */
static MesoStatus start_chains(MesoSplit *split, const MesoDomain *domain, MesoBorderChains *chains, MesoError *error)
{
    const MesoSeedSet *from = &split->step->field.from;
    chains->count = 0;
    for (uint32_t i = 0; i < from->count; i++)
        if (from->specs[i].kind <= MESO_SEED_SIDE)
            return meso_border_chains(split->work, domain, from->specs[i].kind, &from->specs[i], chains, error);
    return MESO_OK;
}

/* First nodes of the lines of starts; MESO_NO_INDEX of those that could not be walked. */
static MesoStatus note_starts(MesoSplit *split, MesoSplitTarget *target, uint32_t first_segment, uint32_t count,
                              MesoError *error)
{
    target->start_count = count;
    target->start_nodes = MESO_NEW(split->work->scratch, uint32_t, count, error);
    if (!target->start_nodes)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < count; i++)
        target->start_nodes[i] = MESO_NO_INDEX;
    for (uint32_t s = first_segment; s < split->lines.segment_count; s++) {
        const MesoCutSegment *segment = &split->lines.segments[s];
        if (target->start_nodes[segment->line] == MESO_NO_INDEX)
            target->start_nodes[segment->line] = segment->node[0];
    }
    return MESO_OK;
}

static MesoStatus trace(MesoSplit *split, MesoSplitTarget *target, const MesoDomain *domain,
                        const MesoMeshPoint *starts, uint32_t count, MesoError *error)
{
    MesoDecorWork *work = split->work;
    const MesoStreamQuery query = {
        .domain = domain, .field = work->field, .join = true, .starts = starts, .start_count = count,
    };
    MesoStreamReport report;
    uint32_t first = split->lines.segment_count;
    MesoStatus status = meso_streamlines_trace(&split->lines, &report, work->scratch, &work->decor->mesh, &query,
                                               error);
    if (status)
        return status;
    if (split->lines.segment_count == first)
        target->idle = "nothing rises from where the lines start";
    return note_starts(split, target, first, count, error);
}

MesoStatus meso_decor_stream(MesoSplit *split, MesoSplitTarget *target, const MesoDomain *domain, MesoError *error)
{
    MesoDecorWork *work = split->work;
    MesoFieldFacts facts;
    MesoBorderChains chains;
    MesoMeshPoint *starts;
    uint32_t count = 0;
    MesoStatus status = meso_decor_field(work, &split->step->field, target->region, domain, &facts, error);
    if (!status)
        status = start_chains(split, domain, &chains, error);
    if (status)
        return status;
    target->largest = facts.largest;
    if (!(facts.largest > 0) || chains.count == 0) {
        target->idle = facts.largest > 0 ? "it has no border to start from" : meso_decor_flat_reason(&facts);
        return MESO_OK;
    }
    status = meso_border_samples(work, &chains, split->step->line_count, 0, &starts, &count, error);
    return status ? status : trace(split, target, domain, starts, count, error);
}
