/*
 * Memory that libraries ask for and do not get. Some go on without it and lose
 * a part of the result, or themselves, without a word: Jansson drops characters
 * while it parses and keys while it prints, streams of C++ swallow the exception,
 * CaDiCaL and tinygltf cannot be taken down after one. So whoever has no use for
 * half a result is told at once, where the memory is asked for.
 */
#ifndef MESO_MEMORY_WATCH_H
#define MESO_MEMORY_WATCH_H

#ifdef __cplusplus
extern "C" {
#endif

/*
 * From now on `out` is called, on whatever thread, where Jansson or the new of
 * C++ find no memory. It should not return: where it does, all is as it was.
 * To be called before there are threads.
 */
void meso_memory_watch(void (*out)(void));

#ifdef __cplusplus
}
#endif

#endif
