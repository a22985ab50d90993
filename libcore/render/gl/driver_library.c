#include "libcore/render/gl/driver_library.h"

#include <dlfcn.h>
#include <string.h>

MesoStatus meso_driver_library(const char *library, const MesoDriverFunction *functions, uint32_t count,
                               MesoError *error)
{
    void *handle = dlopen(library, RTLD_NOW | RTLD_LOCAL);
    for (uint32_t i = 0; handle && i < count; i++) {
        void *found = dlsym(handle, functions[i].name);
        if (!found)
            return meso_fail(error, MESO_ERR_INTERNAL, "%s has no %s", library, functions[i].name);
        memcpy(functions[i].pointer, &found, sizeof found);
    }
    return handle ? MESO_OK : meso_fail(error, MESO_ERR_INTERNAL, "cannot load %s: %s", library, dlerror());
}
