# A torus of n x m quads about z, its tube of radius `tube` about a circle of radius 1, with texture coordinates: one
# for each vertex, or, with cut=1, those of a square.
BEGIN {
    pi = atan2(0, -1)
    w = cut ? n + 1 : n
    h = cut ? m + 1 : m
    for (j = 0; j < m; j++)
        for (i = 0; i < n; i++) {
            a = 2 * pi * i / n; b = 2 * pi * j / m; r = 1 + tube * cos(b)
            printf "v %.6f %.6f %.6f\n", r * cos(a), r * sin(a), tube * sin(b)
        }
    for (j = 0; j < h; j++)
        for (i = 0; i < w; i++)
            printf "vt %.6f %.6f\n", i / n, j / m
    for (j = 0; j < m; j++)
        for (i = 0; i < n; i++) {
            right = (i + 1) % n; up = (j + 1) % m
            u = cut ? i + 1 : right; v = cut ? j + 1 : up
            printf "f %d/%d %d/%d %d/%d %d/%d\n", j * n + i + 1, j * w + i + 1, j * n + right + 1, j * w + u + 1,
                up * n + right + 1, v * w + u + 1, up * n + i + 1, v * w + i + 1
        }
}
