#include "sumo/watch_list.h"

#include <utility>

namespace sumogamma {

bool WatchList::add(const std::string& id, bool is_person) {
  auto& index = is_person ? persons_ : vehicles_;
  if (!index.emplace(id, entries_.size()).second) return false;
  entries_.push_back({id, is_person});
  dropped_.push_back(false);
  return true;
}

bool WatchList::drop(const std::string& id, bool is_person) {
  auto& index = is_person ? persons_ : vehicles_;
  const auto found = index.find(id);
  if (found == index.end()) return false;
  dropped_[found->second] = true;
  ++dropped_count_;
  index.erase(found);
  return true;
}

const std::vector<WatchList::Entry>& WatchList::entries() {
  if (dropped_count_ > 0) compact();
  return entries_;
}

void WatchList::compact() {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    if (dropped_[i]) continue;
    if (kept != i) {
      entries_[kept] = std::move(entries_[i]);
      (entries_[kept].is_person ? persons_ : vehicles_)[entries_[kept].id] = kept;
    }
    ++kept;
  }
  entries_.resize(kept);
  dropped_.assign(kept, false);
  dropped_count_ = 0;
}

}  // namespace sumogamma
