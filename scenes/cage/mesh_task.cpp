// The importer, with files that come from the parent.
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <cstdint>
#include <cstring>
#include <new>
#include <vector>

#include "scenes/cage/files.h"
#include "scenes/cage/tasks.h"

namespace scenes::cage {
namespace {

class FetchedFile : public Assimp::IOStream {
 public:
  explicit FetchedFile(std::string bytes) : bytes_(std::move(bytes)) {}
  size_t Read(void* to, size_t size, size_t count) override {
    const size_t whole = size == 0 ? 0 : std::min(count, (bytes_.size() - at_) / size);
    std::memcpy(to, bytes_.data() + at_, whole * size);
    at_ += whole * size;
    return whole;
  }
  size_t Write(const void*, size_t, size_t) override { return 0; }
  aiReturn Seek(size_t offset, aiOrigin origin) override {
    const size_t from = origin == aiOrigin_SET ? 0 : origin == aiOrigin_CUR ? at_ : bytes_.size();
    const size_t to = origin == aiOrigin_END ? from - std::min(from, offset) : from + offset;
    if (to > bytes_.size()) return aiReturn_FAILURE;
    at_ = to;
    return aiReturn_SUCCESS;
  }
  size_t Tell() const override { return at_; }
  size_t FileSize() const override { return bytes_.size(); }
  void Flush() override {}

 private:
  std::string bytes_;
  size_t at_ = 0;
};

class FetchedFiles : public Assimp::IOSystem {
 public:
  bool Exists(const char* file) const override { return fetch(file).has_value(); }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    if (!mode || mode[0] != 'r' || std::strchr(mode, '+')) return nullptr;
    auto bytes = fetch(file);
    return bytes ? new FetchedFile(std::move(*bytes)) : nullptr;
  }
  void Close(Assimp::IOStream* file) override { delete file; }
};

void append(std::string& out, const void* data, std::size_t bytes) {
  out.append(static_cast<const char*>(data), bytes);
}
template <class T>
void append_array(std::string& out, const T* data, std::size_t count) {
  const std::uint64_t n = count;
  append(out, &n, sizeof n);
  append(out, data, count * sizeof(T));
}

void write_material(std::string& out, const aiMaterial& material) {
  aiString name;
  aiColor3D colour(0.6f, 0.6f, 0.6f);
  float opacity = 1;
  material.Get(AI_MATKEY_NAME, name);
  material.Get(AI_MATKEY_COLOR_DIFFUSE, colour);
  material.Get(AI_MATKEY_OPACITY, opacity);
  const float values[4] = {colour.r, colour.g, colour.b, opacity};
  append_array(out, name.C_Str(), std::strlen(name.C_Str()));
  append_array(out, values, 4);
}

void write_mesh(std::string& out, const aiMesh& mesh) {
  static_assert(sizeof(aiVector3D) == 3 * sizeof(float), "vertices travel as plain floats");
  std::vector<std::uint32_t> indices;
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    if (mesh.mFaces[f].mNumIndices == 3) indices.insert(indices.end(), mesh.mFaces[f].mIndices, mesh.mFaces[f].mIndices + 3);
  }
  append_array(out, &mesh.mVertices[0].x, std::size_t{3} * mesh.mNumVertices);
  if (mesh.mNormals) {
    append_array(out, &mesh.mNormals[0].x, std::size_t{3} * mesh.mNumVertices);
  } else {
    append_array(out, &mesh.mVertices[0].x, 0);
  }
  append_array(out, indices.data(), indices.size());
}

}  // namespace

std::string mesh(const std::string& name) {
  Assimp::Importer importer;
  importer.SetIOHandler(new FetchedFiles);                                 // the importer deletes it
  importer.SetPropertyFloat(AI_CONFIG_PP_GSN_MAX_SMOOTHING_ANGLE, 50.0f);  // sharper edges than this stay edges
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  const aiScene* scene = importer.ReadFile(name, aiProcess_Triangulate | aiProcess_JoinIdenticalVertices | aiProcess_SortByPType |
                                                     aiProcess_GenSmoothNormals | aiProcess_PreTransformVertices);
  const std::string why = scene ? "" : importer.GetErrorString();
  if (why.find("bad_array_new_length") != std::string::npos) throw std::bad_alloc();  // the importer caught it and kept its name
  if (!scene) return "E" + why;
  if (scene->mNumMeshes == 0) return "Ethe file has no triangles";
  std::string out = "M";
  for (unsigned i = 0; i < scene->mNumMeshes; ++i) {
    write_material(out, *scene->mMaterials[scene->mMeshes[i]->mMaterialIndex]);
    write_mesh(out, *scene->mMeshes[i]);
  }
  return out;
}

}  // namespace scenes::cage
