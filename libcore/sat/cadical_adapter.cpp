#include "libcore/sat/cadical_adapter.h"

#include <algorithm>
#include <cadical.hpp>
#include <cstdio>
#include <new>
#include <vector>

namespace {

class Stopper : public CaDiCaL::Terminator {
public:
    bool (*stop)(void *) = nullptr;
    void *context = nullptr;
    bool terminate() override { return stop && stop(context); }
};

/* Each conflict ends in a clause that is learned. */
class ConflictCounter : public CaDiCaL::Learner {
public:
    uint64_t count = 0;
    bool learning(int) override
    {
        count++;
        return false;
    }
    void learn(int) override {}
};

} // namespace

struct MesoSat {
    Stopper stopper;
    ConflictCounter conflicts;
    CaDiCaL::Solver solver;
    std::vector<int> phased;
    bool (*proof)(void *, const char *, size_t) = nullptr;
    void *proof_context = nullptr;
    FILE *proof_file = nullptr;
};

static ssize_t write_proof(void *cookie, const char *data, size_t size)
{
    MesoSat *sat = static_cast<MesoSat *>(cookie);
    return sat->proof(sat->proof_context, data, size) ? static_cast<ssize_t>(size) : 0;
}

/* Reports the exception at hand. */
static MesoStatus fail(MesoError *error)
{
    try {
        throw;
    } catch (const std::bad_alloc &) {
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory in CaDiCaL");
    } catch (const std::exception &e) {
        return meso_fail(error, MESO_ERR_INTERNAL, "CaDiCaL: %s", e.what());
    } catch (...) {
        return meso_fail(error, MESO_ERR_INTERNAL, "CaDiCaL failed");
    }
}

static void close(MesoSat *sat)
{
    if (sat->proof_file) {
        sat->solver.close_proof_trace();
        fclose(sat->proof_file);
    }
    delete sat;
}

static bool open_proof(MesoSat *sat)
{
    cookie_io_functions_t functions = {};
    functions.write = write_proof;
    sat->proof_file = fopencookie(sat, "w", functions);
    return sat->proof_file && sat->solver.trace_proof(sat->proof_file, "proof");
}

extern "C" MesoStatus meso_sat_init(MesoSat **result,
                                    bool (*proof)(void *context, const char *data, size_t size),
                                    void *context, MesoError *error)
{
    *result = nullptr;
    try {
        MesoSat *sat = new MesoSat;
        *result = sat;
        /* The default finds tilings that repeat one tile, the same for every seed. */
        sat->solver.set("lucky", 0);
        sat->solver.set("quiet", 1);
        sat->solver.set("binary", 0);
        sat->proof = proof;
        sat->proof_context = context;
        if (proof && !open_proof(sat))
            return meso_fail(error, MESO_ERR_INTERNAL, "CaDiCaL cannot write its proof");
        sat->solver.connect_terminator(&sat->stopper);
        sat->solver.connect_learner(&sat->conflicts);
        return MESO_OK;
    } catch (...) {
        return fail(error);
    }
}

extern "C" MesoStatus meso_sat_expect_clauses(MesoSat *sat, MesoError *error)
{
    try {
        for (const char *name : {"elim", "block", "cover", "condition", "decompose"})
            sat->solver.set(name, 0);
        return MESO_OK;
    } catch (...) {
        return fail(error);
    }
}

extern "C" void meso_sat_release(MesoSat *sat)
{
    try {
        if (sat)
            close(sat);
    } catch (...) {
        /* Nothing is left to be done. */
    }
}

extern "C" MesoStatus meso_sat_add(MesoSat *sat, const int32_t *literals, uint32_t count, MesoError *error)
{
    try {
        for (uint32_t i = 0; i < count; i++)
            sat->solver.add(literals[i]);
        sat->solver.add(0);
        return MESO_OK;
    } catch (...) {
        return fail(error);
    }
}

extern "C" MesoStatus meso_sat_add_implied(MesoSat *sat, const int32_t *literals, uint32_t count,
                                           MesoError *error)
{
    /* CaDiCaL leaves clauses that it is given out of its proof. */
    for (uint32_t i = 0; sat->proof_file && i < count; i++)
        fprintf(sat->proof_file, "%d ", literals[i]);
    if (sat->proof_file)
        fputs("0\n", sat->proof_file);
    return meso_sat_add(sat, literals, count, error);
}

extern "C" MesoStatus meso_sat_freeze(MesoSat *sat, int32_t variable, MesoError *error)
{
    try {
        sat->solver.freeze(variable);
        return MESO_OK;
    } catch (...) {
        return fail(error);
    }
}

extern "C" uint64_t meso_sat_conflicts(const MesoSat *sat)
{
    return sat->conflicts.count;
}

extern "C" MesoStatus meso_sat_phase(MesoSat *sat, int32_t literal, MesoError *error)
{
    try {
        sat->solver.phase(literal);
        sat->phased.push_back(literal);
        return MESO_OK;
    } catch (...) {
        return fail(error);
    }
}

extern "C" MesoStatus meso_sat_forget_phases(MesoSat *sat, MesoError *error)
{
    try {
        for (int literal : sat->phased)
            sat->solver.unphase(literal);
        sat->phased.clear();
        return MESO_OK;
    } catch (...) {
        return fail(error);
    }
}

extern "C" MesoStatus meso_sat_solve(MesoSat *sat, MesoSatAnswer *answer, const int32_t *assumptions,
                                     uint32_t count, uint32_t conflict_limit,
                                     bool (*stop)(void *context), void *context, MesoError *error)
{
    try {
        sat->stopper.stop = stop;
        sat->stopper.context = context;
        for (uint32_t i = 0; i < count; i++)
            sat->solver.assume(assumptions[i]);
        sat->solver.limit("conflicts", static_cast<int>(std::min<uint32_t>(conflict_limit, INT32_MAX)));
        int status = sat->solver.solve();
        *answer = status == 10 ? MESO_SAT_YES : status == 20 ? MESO_SAT_NO : MESO_SAT_UNKNOWN;
        return MESO_OK;
    } catch (...) {
        return fail(error);
    }
}

extern "C" bool meso_sat_value(MesoSat *sat, int32_t literal)
{
    try {
        return sat->solver.val(literal) > 0;
    } catch (...) {
        return false;
    }
}

extern "C" bool meso_sat_failed(MesoSat *sat, int32_t literal)
{
    try {
        return sat->solver.failed(literal);
    } catch (...) {
        return false;
    }
}
