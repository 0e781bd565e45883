#pragma once

#include <cstddef>
#include <string>
#include <unordered_map>
#include <vector>

namespace sumogamma {

/// The agents asked for with watch(), in the order of asking. Vehicles and persons have separate
/// names.
class WatchList {
 public:
  struct Entry {
    std::string id;
    bool is_person = false;
  };

  /// Adds an agent once; true: it is new.
  bool add(const std::string& id, bool is_person);
  /// Takes an agent out; true: it was in. Keeps the order of the others.
  bool drop(const std::string& id, bool is_person);
  /// Entries in order.
  const std::vector<Entry>& entries();

 private:
  void compact();

  std::vector<Entry> entries_;
  std::vector<bool> dropped_;  // one an entry
  std::size_t dropped_count_ = 0;
  std::unordered_map<std::string, std::size_t> vehicles_,
      persons_;  // id -> index; looked up, never iterated
};

}  // namespace sumogamma
