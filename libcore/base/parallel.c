#include "libcore/base/parallel.h"

#include <assert.h>
#ifdef _OPENMP
#include <omp.h>
#endif

uint32_t meso_parallel_cores(void)
{
#ifdef _OPENMP
    return (uint32_t)omp_get_num_procs();
#else
    return 1;
#endif
}

void meso_parallel_for(uint32_t thread_count, uint64_t count, uint64_t grain,
                       void (*body)(void *context, uint64_t begin, uint64_t end), void *context)
{
    assert(grain > 0);
    int threads = (int)(thread_count ? thread_count : meso_parallel_cores());
    int64_t range_count = (int64_t)((count + grain - 1) / grain);
    (void)threads;

#ifdef _OPENMP
#pragma omp parallel for schedule(dynamic) num_threads(threads)
#endif
    for (int64_t i = 0; i < range_count; i++) {
        uint64_t begin = (uint64_t)i * grain;
        uint64_t end = count - begin < grain ? count : begin + grain;
        body(context, begin, end);
    }
}
