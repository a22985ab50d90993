#include "libcore/base/pipeline.h"

#include <assert.h>
#include <pthread.h>
#include <stdlib.h>

enum { MOST_THREADS = 1024 };

typedef struct Line {
    const MesoPipeline *pipeline;
    pthread_mutex_t lock;       /* of what follows */
    pthread_cond_t changed;
    uint64_t begun, taken;      /* items */
    uint32_t workers;           /* that have come, the caller among them */
    bool over;
    bool *made;                 /* [room] */
} Line;

/* With the lock, which it gives away meanwhile: begins an item if it may. */
static bool make_one(Line *line, uint32_t worker)
{
    const MesoPipeline *p = line->pipeline;
    if (line->over || line->begun == p->count || line->begun - line->taken == p->room)
        return false;
    uint64_t item = line->begun++;
    pthread_mutex_unlock(&line->lock);
    p->make(p->context, worker, item);
    pthread_mutex_lock(&line->lock);
    line->made[item % p->room] = true;
    pthread_cond_broadcast(&line->changed);
    return true;
}

static void *serve(void *argument)
{
    Line *line = argument;
    pthread_mutex_lock(&line->lock);
    uint32_t worker = line->workers++;
    while (!line->over && line->begun < line->pipeline->count)
        if (!make_one(line, worker))
            pthread_cond_wait(&line->changed, &line->lock);
    pthread_mutex_unlock(&line->lock);
    return NULL;
}

/* With the lock. */
static void take_all(Line *line)
{
    const MesoPipeline *p = line->pipeline;
    for (uint64_t item = 0; item < p->count && !line->over; item++) {
        while (!line->made[item % p->room])
            if (!make_one(line, 0))
                pthread_cond_wait(&line->changed, &line->lock);
        pthread_mutex_unlock(&line->lock);
        bool on = p->take(p->context, item);
        pthread_mutex_lock(&line->lock);
        line->made[item % p->room] = false;
        line->taken++;
        line->over = !on;
        pthread_cond_broadcast(&line->changed);
    }
}

/* Where there is no memory to do better. */
static void run_alone(const MesoPipeline *p)
{
    bool on = true;
    for (uint64_t item = 0; item < p->count && on; item++) {
        p->make(p->context, 0, item);
        on = p->take(p->context, item);
    }
}

void meso_pipeline_run(const MesoPipeline *pipeline, uint32_t worker_count)
{
    assert(pipeline->room > 0 && worker_count > 0);
    Line line = {.pipeline = pipeline, .workers = 1, .made = calloc(pipeline->room, sizeof *line.made)};
    if (!line.made) {
        run_alone(pipeline);
        return;
    }
    pthread_t threads[MOST_THREADS];
    uint32_t wanted = worker_count - 1 < MOST_THREADS ? worker_count - 1 : MOST_THREADS, started = 0;
    wanted = wanted < pipeline->count ? wanted : (uint32_t)pipeline->count;
    pthread_mutex_init(&line.lock, NULL);
    pthread_cond_init(&line.changed, NULL);
    while (started < wanted && pthread_create(&threads[started], NULL, serve, &line) == 0)
        started++;
    pthread_mutex_lock(&line.lock);
    take_all(&line);
    pthread_mutex_unlock(&line.lock);
    for (uint32_t i = 0; i < started; i++)
        pthread_join(threads[i], NULL);
    pthread_cond_destroy(&line.changed);
    pthread_mutex_destroy(&line.lock);
    free(line.made);
}
