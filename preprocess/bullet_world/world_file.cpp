#include "preprocess/bullet_world/world_file.h"

#include <BulletFileLoader/btBulletFile.h>
#include <BulletWorldImporter/btBulletWorldImporter.h>
#include <btBulletDynamicsCommon.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <set>

#include "preprocess/bullet_world/file_structure.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/shape/json_schema.h"

AMBIENT_BEGIN
namespace {

std::string fileNameOf(std::string text) {
  for (char& c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) == 0 && c != '-' && c != '_' && c != '.') c = '_';
  }
  // Neither hidden nor the folder itself.
  if (!text.empty() && text.front() == '.') text.front() = '_';
  return text;
}

std::string uniqueName(const std::string& wanted, std::set<std::string>& taken) {
  std::string name = wanted;
  for (int k = 2; !taken.insert(name).second; ++k) name = wanted + "_" + std::to_string(k);
  return name;
}

/// While it lives, what Bullet prints to standard output goes to standard error: the former belongs
/// to results.
class PrintedToErrors {
 public:
  PrintedToErrors() {
    std::fflush(stdout);
    output_ = ::dup(STDOUT_FILENO);
    ::dup2(STDERR_FILENO, STDOUT_FILENO);
  }
  ~PrintedToErrors() {
    std::fflush(stdout);
    ::dup2(output_, STDOUT_FILENO);
    ::close(output_);
  }
  PrintedToErrors(const PrintedToErrors&) = delete;
  PrintedToErrors& operator=(const PrintedToErrors&) = delete;

 private:
  int output_ = -1;
};

/// A parsed file that knows which pointers Bullet could resolve.
class ParsedFile : public bParse::btBulletFile {
 public:
  using btBulletFile::btBulletFile;

  bool holds(const void* address) {
    for (int i = 0; i < mLibPointers.size(); ++i) {
      if (*mLibPointers.getAtIndex(i) == address) return true;
    }
    return false;
  }
};

// Bullet writes no chunk for the name "", and the importer reads the name where there is nothing.
template <class Data, class Name>
void dropLostNames(btAlignedObjectArray<bParse::bStructHandle*>& objects, ParsedFile& file,
                   const Name& name) {
  for (int i = 0; i < objects.size(); ++i) {
    if (objects[i] == nullptr) continue;
    char*& text = name(*reinterpret_cast<Data*>(objects[i]));
    if (!file.holds(text)) text = nullptr;
  }
}

// The structures of objects are those of the file's precision.
void dropLostNames(ParsedFile& file) {
  const auto body_name = [](auto& body) -> char*& { return body.m_collisionObjectData.m_name; };
  const auto own_name = [](auto& data) -> char*& { return data.m_name; };
  if ((file.getFlags() & bParse::FD_DOUBLE_PRECISION) != 0) {
    dropLostNames<btRigidBodyDoubleData>(file.m_rigidBodies, file, body_name);
    dropLostNames<btCollisionObjectDoubleData>(file.m_collisionObjects, file, own_name);
  } else {
    dropLostNames<btRigidBodyFloatData>(file.m_rigidBodies, file, body_name);
    dropLostNames<btCollisionObjectFloatData>(file.m_collisionObjects, file, own_name);
  }
  dropLostNames<btCollisionShapeData>(file.m_collisionShapes, file, own_name);
}

}  // namespace

struct WorldFile::Importer : btBulletWorldImporter {
  ~Importer() override { deleteAllData(); }

  bool convertAllObjects(bParse::btBulletFile* file) override {
    dropLostNames(static_cast<ParsedFile&>(*file));
    return btBulletWorldImporter::convertAllObjects(file);
  }

  std::string nameOf(const void* object) const {
    const char* name = getNameForPointer(object);
    return name != nullptr ? name : "";
  }
};

WorldFile::WorldFile(const std::filesystem::path& file) : importer_(std::make_unique<Importer>()) {
  std::string bytes = readBytes(file);
  checkFileStructure(bytes, file.string());
  {
    const PrintedToErrors while_loading;
    ParsedFile parsed(bytes.data(), static_cast<int>(bytes.size()));
    if (!importer_->loadFileFromMemory(&parsed)) {
      raiseInputError(file.string(), "Bullet cannot read it");
    }
    lost_bodies_ = parsed.m_rigidBodies.size() - importer_->getNumRigidBodies();
    multibodies_ = parsed.m_multiBodies.size();
  }
  for (int i = 0; i < importer_->getNumRigidBodies(); ++i) {
    const btRigidBody* body = btRigidBody::upcast(importer_->getRigidBodyByIndex(i));
    if (body == nullptr || !(body->getInvMass() > 0)) continue;
    const btCollisionShape* shape = body->getCollisionShape();
    auto known = std::find_if(shapes_.begin(), shapes_.end(),
                              [&](const WorldShape& s) { return s.shape == shape; });
    if (known == shapes_.end()) known = shapes_.insert(known, {"", shape, {}});
    const std::string name = importer_->nameOf(body);
    known->bodies.push_back(name.empty() ? "body " + std::to_string(i) : name);
  }
  std::set<std::string> taken;
  for (WorldShape& shape : shapes_) {
    const std::string own = importer_->nameOf(shape.shape);
    const bool is_shared = shape.bodies.size() > 1 && !own.empty();
    shape.name = uniqueName(fileNameOf(is_shared ? own : shape.bodies.front()), taken);
  }
}

WorldFile::~WorldFile() = default;

AMBIENT_END
