#include "formats/file/memory_watch.h"

#include <cstdlib>
#include <jansson.h>
#include <new>

namespace {

void (*memory_is_out)(void);

void *allocate(size_t size)
{
    void *memory = std::malloc(size);
    if (!memory)
        memory_is_out();
    return memory;
}

/* A handler that returns would be asked again, for ever. */
void tell_and_throw()
{
    memory_is_out();
    throw std::bad_alloc();
}

}

extern "C" void meso_memory_watch(void (*out)(void))
{
    memory_is_out = out;
    json_set_alloc_funcs(allocate, std::free);
    std::set_new_handler(tell_and_throw);
}
