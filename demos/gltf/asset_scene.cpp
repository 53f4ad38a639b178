#include "demos/gltf/asset_scene.h"

#include <assimp/material.h>

#include <algorithm>
#include <array>

#include "bullet_ambient/spatial/rotation.h"
#include "demos/gltf/motion_keys.h"

namespace ambient {
namespace {

// Colours of bodies: linear red, green, blue.
constexpr std::array<std::array<float, 3>, 6> kColours = {{{0.013f, 0.158f, 0.831f},
                                                           {0.694f, 0.065f, 0.004f},
                                                           {0.024f, 0.254f, 0.056f},
                                                           {0.332f, 0.037f, 0.462f},
                                                           {0.807f, 0.371f, 0.0f},
                                                           {0.003f, 0.198f, 0.258f}}};
constexpr std::array<float, 3> kStaticColour = {0.48f, 0.54f, 0.6f};

/// Allocates an array of pointers; the aiScene takes ownership.
template <class T>
T** makePointers(std::size_t count) {
  return new T* [count] {};
}

aiVector3D toAsset(const Vector3& v) {
  return {static_cast<ai_real>(v.x()), static_cast<ai_real>(v.y()), static_cast<ai_real>(v.z())};
}

aiQuaternion toAsset(const Quaternion& q) {
  const Eigen::Quaternionf rounded = q.cast<float>().normalized();
  return {rounded.w(), rounded.x(), rounded.y(), rounded.z()};
}

aiMatrix4x4 toMatrix(const Quaternion& rotation, const Vector3& translation) {
  return {aiVector3D(1, 1, 1), toAsset(rotation), toAsset(translation)};
}

aiMesh* makeMesh(const Surface& surface, unsigned material) {
  auto mesh = std::make_unique<aiMesh>();
  mesh->mPrimitiveTypes = aiPrimitiveType_TRIANGLE;
  mesh->mMaterialIndex = material;
  mesh->mName = aiString(std::to_string(material));
  mesh->mNumVertices = static_cast<unsigned>(surface.vertices.size() / 3);
  mesh->mVertices = new aiVector3D[mesh->mNumVertices];
  for (unsigned i = 0; i < mesh->mNumVertices; ++i)
    mesh->mVertices[i] = toAsset(Eigen::Map<const Vector3>(&surface.vertices[3 * i]));
  mesh->mNumFaces = static_cast<unsigned>(surface.triangles.size() / 3);
  mesh->mFaces = new aiFace[mesh->mNumFaces];
  for (unsigned i = 0; i < mesh->mNumFaces; ++i) {
    mesh->mFaces[i].mNumIndices = 3;
    mesh->mFaces[i].mIndices = new unsigned[3];
    std::copy_n(&surface.triangles[3 * i], 3, mesh->mFaces[i].mIndices);
  }
  return mesh.release();
}

aiMaterial* makeMaterial(bool is_static, std::size_t index) {
  const std::array<float, 3> colour = is_static ? kStaticColour : kColours[index % kColours.size()];
  const aiColor4D base(colour[0], colour[1], colour[2], 1);
  const aiString name(std::to_string(index));
  const float metallic = 0, roughness = 0.6f;
  const int two_sided = 1;
  auto material = std::make_unique<aiMaterial>();
  material->AddProperty(&name, AI_MATKEY_NAME);
  material->AddProperty(&base, 1, AI_MATKEY_BASE_COLOR);
  material->AddProperty(&metallic, 1, AI_MATKEY_METALLIC_FACTOR);
  material->AddProperty(&roughness, 1, AI_MATKEY_ROUGHNESS_FACTOR);
  material->AddProperty(&two_sided, 1, AI_MATKEY_TWOSIDED);
  return material.release();
}

aiNode* makeNode(const BodyDef& def, unsigned index) {
  auto node = std::make_unique<aiNode>(std::to_string(index));
  node->mTransformation = toMatrix(def.orientation, def.position);
  node->mNumMeshes = 1;
  node->mMeshes = new unsigned[1]{index};
  return node.release();
}

aiNodeAnim* makeChannel(const std::vector<MotionSample>& motion, std::size_t index) {
  const std::vector<MotionSample> keys = makeMotionKeys(motion);
  auto channel = std::make_unique<aiNodeAnim>();
  channel->mNodeName = aiString(std::to_string(index));
  channel->mNumPositionKeys = channel->mNumRotationKeys = static_cast<unsigned>(keys.size());
  channel->mPositionKeys = new aiVectorKey[keys.size()];
  channel->mRotationKeys = new aiQuatKey[keys.size()];
  for (std::size_t k = 0; k < keys.size(); ++k) {
    channel->mPositionKeys[k] = {keys[k].time, toAsset(keys[k].position)};
    channel->mRotationKeys[k] = {keys[k].time, toAsset(keys[k].orientation)};
  }
  return channel.release();
}

aiAnimation* makeAnimation(const Scene& scene, const std::vector<PreparedBody>& bodies,
                           const std::vector<std::vector<MotionSample>>& motion) {
  auto animation = std::make_unique<aiAnimation>();
  animation->mName = aiString(scene.name);
  animation->mDuration = scene.duration;
  animation->mTicksPerSecond = 1;
  animation->mChannels = makePointers<aiNodeAnim>(bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i)
    if (bodies[i].mass > 0)
      animation->mChannels[animation->mNumChannels++] = makeChannel(motion[i], i);
  return animation.release();
}

}  // namespace

Quaternion upToY(const Vector3& gravity) {
  const Vector3 up = gravity.isZero() ? Vector3::UnitZ() : Vector3(-gravity);
  return rotationBetween(up, Vector3::UnitY());
}

std::unique_ptr<aiScene> makeAssetScene(const Scene& scene, const std::vector<PreparedBody>& bodies,
                                        const std::vector<std::vector<MotionSample>>& motion) {
  auto asset = std::make_unique<aiScene>();
  const auto count = static_cast<unsigned>(bodies.size());
  asset->mMeshes = makePointers<aiMesh>(count);
  asset->mMaterials = makePointers<aiMaterial>(count);
  asset->mRootNode = new aiNode("world");
  asset->mRootNode->mTransformation = toMatrix(upToY(scene.gravity), Vector3::Zero());
  std::vector<aiNode*> nodes;
  for (unsigned i = 0; i < count; ++i) {
    asset->mMeshes[asset->mNumMeshes++] =
        makeMesh(moved(bodies[i].surface, -bodies[i].centre_of_mass), i);
    asset->mMaterials[asset->mNumMaterials++] = makeMaterial(bodies[i].mass == 0, i);
    nodes.push_back(makeNode(scene.bodies[i], i));
  }
  asset->mRootNode->addChildren(count, nodes.data());
  const bool something_moves = std::any_of(bodies.begin(), bodies.end(),
                                           [](const PreparedBody& body) { return body.mass > 0; });
  if (something_moves) {  // an animation must have a channel
    asset->mAnimations = makePointers<aiAnimation>(1);
    asset->mAnimations[asset->mNumAnimations++] = makeAnimation(scene, bodies, motion);
  }
  return asset;
}

}  // namespace ambient
