/* glTF 2.0, sections 3.7 (skins and morph targets) and 3.11 with appendix C (animations and their interpolation). */
#include "formats/mesh/gltf/gltf_clip.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <new>

#include "formats/mesh/gltf/gltf_file.hpp"
#include "formats/mesh/gltf/gltf_nodes.hpp"
#include "formats/mesh/gltf/gltf_primitive.hpp"
#include "formats/mesh/gltf/mesh_gatherer.hpp"
#include "libcore/mesh/polygon_mesh.h"

namespace {

using meso::at;
using meso::BrokenGltf;
using meso::Matrix;

enum class Path { translation, rotation, scale, weights };

struct Channel {
    int node;
    Path path;
    bool step, cubic;
    std::size_t width;              /* numbers a key */
    std::vector<float> times, values;
};

/* A primitive at rest, and what moves it. */
struct Part {
    int node;
    std::size_t first, count;       /* vertices */
    std::vector<float> positions;
    std::vector<std::vector<float>> targets;
    std::vector<uint32_t> joints;   /* four or eight a vertex, of the skin; empty: no skin */
    std::vector<float> weights;
};

struct Skin {
    std::vector<int> joints;
    std::vector<Matrix> inverse;    /* [joints.size()] */
};

}

struct MesoGltfClip {
    std::string path;
    tinygltf::Model model;
    std::vector<Channel> channels;
    std::vector<Part> parts;
    std::vector<Skin> skins;
    std::size_t vertex_count = 0, most = 0, numbers = 0;
    double duration = 0;
};

namespace {

/* ---- reading ---- */

std::size_t count_of(const MesoGltfClip &clip, int accessor)
{
    std::size_t count = at(clip.model.accessors, accessor, "accessor").count;
    if (count > clip.most)
        throw BrokenGltf("accessor " + std::to_string(accessor) + " is absurdly large for its file");
    return count;
}

/* Numbers of an accessor whose elements have `width`; all that is read together is bounded. */
std::vector<float> numbers_of(MesoGltfClip &clip, int accessor, std::size_t count, std::size_t width)
{
    if (count_of(clip, accessor) != count ||
        meso::component_count(at(clip.model.accessors, accessor, "accessor")) != width)
        throw BrokenGltf("accessor " + std::to_string(accessor) + " is not of " + std::to_string(count) +
                         " elements with " + std::to_string(width) + " numbers");
    clip.numbers += count * width;
    if (clip.numbers > clip.most)
        throw std::length_error("its animation takes too many numbers");
    return meso::floats_of(clip.model, accessor, count);
}

std::size_t target_count(const tinygltf::Model &model, int node)
{
    int mesh = at(model.nodes, node, "node").mesh;
    if (mesh < 0 || at(model.meshes, mesh, "mesh").primitives.empty())
        throw BrokenGltf("weights of node " + std::to_string(node) + ", which has no mesh");
    return model.meshes[static_cast<std::size_t>(mesh)].primitives[0].targets.size();
}

/* Whether the channel is one that moves something here. */
bool find_path(const std::string &name, Path *path)
{
    static const char *const names[] = {"translation", "rotation", "scale", "weights"};
    for (int i = 0; i < 4; i++)
        if (name == names[i]) {
            *path = static_cast<Path>(i);
            return true;
        }
    return false;
}

void add_channel(MesoGltfClip &clip, const tinygltf::Animation &animation, const tinygltf::AnimationChannel &from)
{
    Channel channel;
    if (from.target_node < 0 || !find_path(from.target_path, &channel.path))
        return;
    const tinygltf::AnimationSampler &sampler = at(animation.samplers, from.sampler, "sampler");
    at(clip.model.nodes, from.target_node, "node");
    channel.node = from.target_node;
    channel.step = sampler.interpolation == "STEP";
    channel.cubic = sampler.interpolation == "CUBICSPLINE";
    channel.width = channel.path == Path::rotation ? 4 : 3;
    std::size_t keys = count_of(clip, sampler.input), elements = keys * (channel.cubic ? 3 : 1), width = channel.width;
    if (channel.path == Path::weights) {
        channel.width = target_count(clip.model, channel.node);
        if (channel.width > clip.most / (elements + 1))
            throw std::length_error("its animation takes too many numbers");
        elements *= channel.width;
        width = 1;
    }
    channel.times = numbers_of(clip, sampler.input, keys, 1);
    channel.values = numbers_of(clip, sampler.output, elements, width);
    for (std::size_t i = 0; i < keys; i++)
        if (!(channel.times[i] >= 0 && std::isfinite(channel.times[i])) ||
            (i && channel.times[i] <= channel.times[i - 1]))
            throw BrokenGltf("times of an animation do not ascend");
    if (keys == 0 || channel.width == 0)
        return;
    clip.duration = std::max(clip.duration, static_cast<double>(channel.times.back()));
    clip.channels.push_back(std::move(channel));
}

void add_skins(MesoGltfClip &clip)
{
    for (const tinygltf::Skin &from : clip.model.skins) {
        Skin skin;
        skin.joints = from.joints;
        skin.inverse.resize(from.joints.size());
        for (int joint : from.joints)
            at(clip.model.nodes, joint, "node");
        if (from.inverseBindMatrices >= 0) {
            std::vector<float> values = numbers_of(clip, from.inverseBindMatrices,
                                                   count_of(clip, from.inverseBindMatrices), 16);
            if (values.size() < 16 * skin.inverse.size())
                throw BrokenGltf("a skin has more joints than matrices");
            for (std::size_t i = 0; i < 16 * skin.inverse.size(); i++)
                skin.inverse[i / 16].m[i % 16] = static_cast<double>(values[i]);
        }
        clip.skins.push_back(std::move(skin));
    }
}

/* Four joints a vertex, and four more where there are. */
void add_joints(MesoGltfClip &clip, const meso::Primitive &primitive, Part &part, std::size_t joint_count)
{
    std::size_t sets = primitive.has("JOINTS_1") && primitive.has("WEIGHTS_1") ? 2 : 1;
    part.joints.resize(4 * sets * part.count);
    part.weights.resize(part.joints.size());
    clip.numbers += 2 * part.joints.size();
    for (std::size_t set = 0; set < sets; set++) {
        std::string number = std::to_string(set);
        if (primitive.width("JOINTS_" + number) != 4 || primitive.width("WEIGHTS_" + number) != 4)
            throw BrokenGltf("joints and weights are not of four numbers");
        std::vector<uint32_t> joints = primitive.wholes("JOINTS_" + number);
        std::vector<float> weights = primitive.floats("WEIGHTS_" + number);
        for (std::size_t i = 0; i < 4 * part.count; i++) {
            std::size_t place = i / 4 * 4 * sets + 4 * set + i % 4;
            if (joints[i] >= joint_count)
                throw BrokenGltf("a vertex follows joint " + std::to_string(joints[i]) + " of " +
                                 std::to_string(joint_count));
            part.joints[place] = joints[i];
            part.weights[place] = weights[i];
        }
    }
}

void add_part(MesoGltfClip &clip, int node, const tinygltf::Primitive &from)
{
    meso::Primitive primitive(clip.model, from, clip.most);
    Part part;
    int skin = clip.model.nodes[static_cast<std::size_t>(node)].skin;
    part.node = node;
    part.first = clip.vertex_count;
    part.count = primitive.vertex_count();
    if (clip.vertex_count + part.count >= clip.most)
        throw std::length_error("its nodes make too many triangles of it");
    if (primitive.width("POSITION") != 3)
        throw BrokenGltf("positions are not of three numbers");
    part.positions = primitive.floats("POSITION");
    for (const auto &target : from.targets) {
        auto position = target.find("POSITION");
        part.targets.push_back(position == target.end() ? std::vector<float>()
                                                        : numbers_of(clip, position->second, part.count, 3));
    }
    if (skin >= 0 && primitive.has("JOINTS_0") && primitive.has("WEIGHTS_0"))
        add_joints(clip, primitive, part, at(clip.skins, skin, "skin").joints.size());
    if (clip.numbers > clip.most)
        throw std::length_error("its animation takes too many numbers");
    clip.vertex_count += part.count;
    clip.parts.push_back(std::move(part));
}

void read_all(MesoGltfClip &clip, const MesoInput *input)
{
    std::size_t size = 0;
    clip.path = input->path;
    meso::load_gltf(&clip.model, &size, input);
    clip.most = meso::most_corners(size);
    if (clip.model.animations.empty())
        throw BrokenGltf("there is no animation in it");
    add_skins(clip);
    for (const tinygltf::AnimationChannel &channel : clip.model.animations[0].channels)
        add_channel(clip, clip.model.animations[0], channel);
    for (const meso::PlacedNode &placed : meso::nodes_of_scene(clip.model, meso::locals_of(clip.model))) {
        int mesh = clip.model.nodes[static_cast<std::size_t>(placed.node)].mesh;
        if (mesh < 0)
            continue;
        for (const tinygltf::Primitive &primitive : at(clip.model.meshes, mesh, "mesh").primitives)
            if (meso::is_shown(primitive))
                add_part(clip, placed.node, primitive);
    }
}

/* ---- a pose ---- */

void make_unit(std::vector<double> &q)
{
    double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (!(length > 0))
        q = {0, 0, 0, 1};
    else
        for (double &x : q)
            x /= length;
}

/* The shorter way round, at constant speed; along the chord where that is as good. */
std::vector<double> turned(const float *a, const float *b, double t)
{
    std::vector<double> out(4);
    double cosine = 0;
    for (std::size_t i = 0; i < 4; i++)
        cosine += static_cast<double>(a[i]) * static_cast<double>(b[i]);
    double sign = cosine < 0 ? -1 : 1, angle = std::acos(std::fmin(1, std::fabs(cosine))), sine = std::sin(angle);
    double from = sine > 1e-6 ? std::sin((1 - t) * angle) / sine : 1 - t;
    double to = sine > 1e-6 ? std::sin(t * angle) / sine : t;
    for (std::size_t i = 0; i < 4; i++)
        out[i] = from * static_cast<double>(a[i]) + sign * to * static_cast<double>(b[i]);
    make_unit(out);
    return out;
}

std::vector<double> value_at(const Channel &channel, double time)
{
    const std::vector<float> &times = channel.times;
    std::size_t width = channel.width, stride = channel.cubic ? 3 * width : width, middle = channel.cubic ? width : 0;
    std::size_t next = static_cast<std::size_t>(
        std::upper_bound(times.begin(), times.end(), time,
                         [](double t, float key) { return t < static_cast<double>(key); }) - times.begin());
    std::size_t last = next ? next - 1 : 0;
    const float *a = channel.values.data() + stride * last + middle;
    std::vector<double> out(width);
    for (std::size_t i = 0; i < width; i++)
        out[i] = static_cast<double>(a[i]);
    if (next == 0 || next == times.size() || channel.step) {
        if (channel.path == Path::rotation)
            make_unit(out);
        return out;
    }
    const float *b = a + stride;
    double from = static_cast<double>(times[last]), length = static_cast<double>(times[next]) - from;
    double t = (time - from) / length;
    if (channel.path == Path::rotation && !channel.cubic)
        return turned(a, b, t);
    for (std::size_t i = 0; i < width; i++) {
        double p = static_cast<double>(a[i]), q = static_cast<double>(b[i]);
        if (!channel.cubic) {
            out[i] = p + t * (q - p);
            continue;
        }
        double leave = length * static_cast<double>(a[width + i]);
        double arrive = length * static_cast<double>((b - width)[i]);
        double t2 = t * t, t3 = t2 * t;
        out[i] = (2 * t3 - 3 * t2 + 1) * p + (t3 - 2 * t2 + t) * leave + (3 * t2 - 2 * t3) * q + (t3 - t2) * arrive;
    }
    if (channel.path == Path::rotation)
        make_unit(out);
    return out;
}

struct Pose {
    std::vector<Matrix> world;                      /* by node */
    std::vector<std::vector<double>> weights;       /* by node */
};

Pose pose_at(const MesoGltfClip &clip, double time)
{
    const tinygltf::Model &model = clip.model;
    Pose pose;
    std::vector<Matrix> locals = meso::locals_of(model);
    std::vector<bool> moved(model.nodes.size());
    std::vector<tinygltf::Node> nodes(model.nodes.size());
    pose.weights.resize(model.nodes.size());
    for (std::size_t i = 0; i < model.nodes.size(); i++) {
        const tinygltf::Node &node = model.nodes[i];
        nodes[i].translation = node.translation;
        nodes[i].rotation = node.rotation;
        nodes[i].scale = node.scale;
        bool own = !node.weights.empty() || node.mesh < 0;
        pose.weights[i] = own ? node.weights : at(model.meshes, node.mesh, "mesh").weights;
    }
    for (const Channel &channel : clip.channels) {
        auto number = static_cast<std::size_t>(channel.node);
        tinygltf::Node &node = nodes[number];
        std::vector<double> &target = channel.path == Path::translation ? node.translation
                                      : channel.path == Path::rotation  ? node.rotation
                                      : channel.path == Path::scale     ? node.scale
                                                                        : pose.weights[number];
        target = value_at(channel, time);
        moved[number] = moved[number] || channel.path != Path::weights;
    }
    for (std::size_t i = 0; i < nodes.size(); i++)
        if (moved[i])
            locals[i] = meso::matrix_of(nodes[i]);
    pose.world.resize(nodes.size());
    for (const meso::PlacedNode &placed : meso::nodes_of_scene(model, locals))
        pose.world[static_cast<std::size_t>(placed.node)] = placed.world;
    return pose;
}

/* ---- positions ---- */

/* A skinned mesh goes by its joints alone, wherever its own node is. */
Matrix blend_of(const Part &part, std::size_t vertex, const std::vector<Matrix> &joints)
{
    Matrix out;
    double sum = 0;
    std::size_t width = part.joints.size() / part.count;
    std::fill(out.m, out.m + 16, 0.0);
    for (std::size_t k = vertex * width; k < (vertex + 1) * width; k++) {
        double weight = static_cast<double>(part.weights[k]);
        for (int i = 0; i < 16 && weight != 0; i++)
            out.m[i] += weight * joints[part.joints[k]].m[i];
        sum += weight;
    }
    for (int i = 0; i < 16 && sum != 0; i++)
        out.m[i] /= sum;
    return out;
}

std::vector<Matrix> joints_of(const MesoGltfClip &clip, const Part &part, const Pose &pose)
{
    std::vector<Matrix> out;
    if (part.joints.empty())
        return out;
    const Skin &skin = at(clip.skins, at(clip.model.nodes, part.node, "node").skin, "skin");
    for (std::size_t j = 0; j < skin.joints.size(); j++)
        out.push_back(product(pose.world[static_cast<std::size_t>(skin.joints[j])], skin.inverse[j]));
    return out;
}

void place_part(const MesoGltfClip &clip, const Part &part, const Pose &pose, MesoVec3 *positions)
{
    auto node = static_cast<std::size_t>(part.node);
    const std::vector<double> &weights = pose.weights[node];
    std::vector<Matrix> joints = joints_of(clip, part, pose);
    for (std::size_t v = 0; v < part.count; v++) {
        double p[3], q[3];
        for (std::size_t k = 0; k < 3; k++) {
            p[k] = static_cast<double>(part.positions[3 * v + k]);
            for (std::size_t t = 0; t < part.targets.size() && t < weights.size(); t++)
                if (!part.targets[t].empty())
                    p[k] += weights[t] * static_cast<double>(part.targets[t][3 * v + k]);
        }
        Matrix world = joints.empty() ? pose.world[node] : blend_of(part, v, joints);
        for (int row = 0; row < 3; row++)
            q[row] = world.m[row] * p[0] + world.m[4 + row] * p[1] + world.m[8 + row] * p[2] + world.m[12 + row];
        positions[part.first + v] = MesoVec3{static_cast<float>(q[0]), static_cast<float>(q[1]),
                                             static_cast<float>(q[2])};
    }
}

bool is_place(MesoVec3 p)
{
    return std::fabs(p.x) <= MESO_COORDINATE_LIMIT && std::fabs(p.y) <= MESO_COORDINATE_LIMIT &&
           std::fabs(p.z) <= MESO_COORDINATE_LIMIT;
}

}

extern "C" MesoStatus meso_gltf_clip_open(MesoGltfClip **clip, const MesoInput *input, MesoError *error)
try {
    *clip = nullptr;
    auto made = std::make_unique<MesoGltfClip>();
    read_all(*made, input);
    *clip = made.release();
    return MESO_OK;
} catch (const std::bad_alloc &) {
    return meso_fail(error, MESO_ERR_MEMORY, "%s: out of memory for glTF", input->path);
} catch (const std::length_error &exception) {
    return meso_fail(error, MESO_ERR_LIMIT, "%s: %s", input->path, exception.what());
} catch (const std::exception &exception) {
    return meso_fail(error, MESO_ERR_INPUT, "%s: broken glTF: %s", input->path, exception.what());
} catch (...) {
    return meso_fail(error, MESO_ERR_INPUT, "%s: broken glTF", input->path);
}

extern "C" void meso_gltf_clip_release(MesoGltfClip *clip) { delete clip; }

extern "C" uint32_t meso_gltf_clip_vertex_count(const MesoGltfClip *clip)
{
    return static_cast<uint32_t>(clip->vertex_count);
}

extern "C" double meso_gltf_clip_duration(const MesoGltfClip *clip) { return clip->duration; }

extern "C" MesoStatus meso_gltf_clip_positions(const MesoGltfClip *clip, double time, MesoVec3 *positions,
                                               MesoError *error)
try {
    Pose pose = pose_at(*clip, time);
    for (const Part &part : clip->parts)
        place_part(*clip, part, pose, positions);
    for (std::size_t v = 0; v < clip->vertex_count; v++)
        if (!is_place(positions[v]))
            return meso_fail(error, MESO_ERR_INPUT, "%s: at %g s, vertex %zu: coordinates that are not finite, or "
                             "beyond 1e18", clip->path.c_str(), time, v + 1);
    return MESO_OK;
} catch (const std::bad_alloc &) {
    return meso_fail(error, MESO_ERR_MEMORY, "%s: out of memory for glTF", clip->path.c_str());
} catch (...) {
    return meso_fail(error, MESO_ERR_INPUT, "%s: broken glTF", clip->path.c_str());
}
