/* Threads that stay from loop to loop: for loops that are too short to start threads for. */
#ifndef MESO_TEAM_H
#define MESO_TEAM_H

#include <stdint.h>

typedef struct MesoTeam MesoTeam;

/* A moment, between looks at what another thread does. */
static inline void meso_relax(void)
{
#if defined(__x86_64__) || defined(__i386__)
    __builtin_ia32_pause();
#endif
}

/*
 * A team of `thread_count` threads (0: all cores), of which the one that calls its loops is one; those that the system
 * refuses are done without. NULL, a team of the caller alone, where it has no other.
 */
MesoTeam *meso_team_begin(uint32_t thread_count);

/* Threads that it has, the caller among them: at least one, and no more than were wanted. */
uint32_t meso_team_size(const MesoTeam *team);

/* Ends the threads; nothing where it is NULL. */
void meso_team_end(MesoTeam *team);

/*
 * As meso_parallel_for() does, with the threads of the team. Threads that come late, since the machine has other things
 * to do, are not waited for. Not to be called within a loop of the same team.
 */
void meso_team_for(MesoTeam *team, uint64_t count, uint64_t grain,
                   void (*body)(void *context, uint64_t begin, uint64_t end), void *context);

/* The same, and says which of the team's threads runs the range, as meso_parallel_team() does. */
void meso_team_work(MesoTeam *team, uint64_t count, uint64_t grain,
                    void (*body)(void *context, uint32_t worker, uint64_t begin, uint64_t end), void *context);

#endif
