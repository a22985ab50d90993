#include "formats/mesh/gltf/gltf_matrix.hpp"

#include <cstring>

namespace meso {

Matrix product(const Matrix &a, const Matrix &b)
{
    Matrix out;
    for (int column = 0; column < 4; column++)
        for (int row = 0; row < 4; row++) {
            double sum = 0;
            for (int k = 0; k < 4; k++)
                sum += a.m[4 * k + row] * b.m[4 * column + k];
            out.m[4 * column + row] = sum;
        }
    return out;
}

Matrix matrix_of(const tinygltf::Node &node)
{
    Matrix out;
    if (node.matrix.size() == 16) {
        std::memcpy(out.m, node.matrix.data(), sizeof out.m);
        return out;
    }
    double q[4] = {0, 0, 0, 1}, s[3] = {1, 1, 1}, t[3] = {0, 0, 0};
    for (std::size_t i = 0; i < 4 && node.rotation.size() == 4; i++)
        q[i] = node.rotation[i];
    for (std::size_t i = 0; i < 3; i++) {
        s[i] = node.scale.size() == 3 ? node.scale[i] : s[i];
        t[i] = node.translation.size() == 3 ? node.translation[i] : t[i];
    }
    double x = q[0], y = q[1], z = q[2], w = q[3];
    const double rotation[9] = {1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w),
                                2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w),
                                2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)};
    for (int column = 0; column < 3; column++)
        for (int row = 0; row < 3; row++)
            out.m[4 * column + row] = rotation[3 * column + row] * s[column];
    for (int row = 0; row < 3; row++)
        out.m[12 + row] = t[row];
    return out;
}

Turn turn_of(const Matrix &a)
{
    Turn out;
    auto e = [&](int row, int column) { return a.m[4 * column + row]; };
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 3; column++) {
            int r1 = (row + 1) % 3, r2 = (row + 2) % 3, c1 = (column + 1) % 3, c2 = (column + 2) % 3;
            out.m[3 * column + row] = e(r1, c1) * e(r2, c2) - e(r1, c2) * e(r2, c1);
        }
    double determinant = 0;
    for (int row = 0; row < 3; row++)
        determinant += e(row, 0) * out.m[row];
    out.mirrors = determinant < 0;
    return out;
}

}
