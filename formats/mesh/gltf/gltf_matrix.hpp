/* Affine matrices of glTF's nodes. */
#ifndef MESO_GLTF_MATRIX_HPP
#define MESO_GLTF_MATRIX_HPP

#include <tiny_gltf.h>

namespace meso {

/* A column-major 4 x 4 matrix, of which the last row is 0 0 0 1. */
struct Matrix {
    double m[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
};

Matrix product(const Matrix &a, const Matrix &b);
Matrix matrix_of(const tinygltf::Node &node);

/* The cofactors of the upper 3 x 3, which turn normals as the matrix turns surfaces; the sign tells whether it mirrors. */
struct Turn {
    double m[9];
    bool mirrors;
};

Turn turn_of(const Matrix &matrix);

}

#endif
