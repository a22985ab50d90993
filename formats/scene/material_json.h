/* Materials of a scene as JSON: in models, and in quilts; and as people write them in patterns and details. */
#ifndef MESO_MATERIAL_JSON_H
#define MESO_MATERIAL_JSON_H

#include "formats/json/json_field.h"
#include "libcore/scene/material.h"

/* [{"name", "albedo", "roughness", "metallic"}]; NULL where memory is out. */
json_t *meso_materials_to_json(uint32_t count, const MesoMaterial *materials, const char *const *names);

/* The same back, to the reader's arena; at most 65535. Problems are the reader's. */
void meso_materials_of_json(const MesoJsonField *list, uint32_t *count, MesoMaterial **materials, const char ***names);

/* What has no material. */
extern const MesoMaterial meso_plain_material;

/* A colour (meso_json_color()), or an object with "color", "roughness" and "metallic"; what is missing is plain. */
void meso_material_of_json(const MesoJsonField *field, MesoMaterial *material);

#endif
