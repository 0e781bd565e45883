#include "ego/plan_tree.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace sumogamma {

namespace {

constexpr double kLevel = 74.0, kEdge = 24.0, kHead = 58.0;  // [px]
constexpr double kTallest = 1500.0, kLeaf = 12.0;            // all leaves; one of few [px]

/// How a branch of an acceleration is drawn: not by colour alone.
struct Branch {
  const char *words, *colour, *dashes;
};
Branch branch_of(double acceleration) {
  if (acceleration > 0.0) return {"accelerate", "#0b5394", "none"};
  if (acceleration < 0.0) return {"brake", "#b35900", "5 3"};
  return {"keep the speed", "#57606a", "1 3"};
}

/// Heights of nodes [px]: leaves one below the other, others amid their children.
std::vector<double> heights(const std::vector<PlanTrace::TreeNode>& tree) {
  std::vector<std::vector<std::size_t>> children(tree.size());
  for (std::size_t k = 1; k < tree.size(); ++k)
    children[static_cast<std::size_t>(tree[k].parent)].push_back(k);
  for (std::vector<std::size_t>& below : children)
    std::stable_sort(below.begin(), below.end(), [&](std::size_t a, std::size_t b) {
      return tree[a].acceleration > tree[b].acceleration;
    });
  const auto leaves = std::count_if(children.begin(), children.end(),
                                    [](const auto& below) { return below.empty(); });
  const double leaf = std::min(kLeaf, kTallest / static_cast<double>(leaves));
  std::vector<double> height(tree.size(), 0.0);
  double next = kHead;
  // down one branch after the other; a node is left when its children have their places
  std::vector<std::pair<std::size_t, std::size_t>> way{{0, 0}};
  while (!way.empty()) {
    auto& [node, child] = way.back();
    if (child < children[node].size()) {
      way.emplace_back(children[node][child++], 0);
      continue;
    }
    const std::vector<std::size_t>& below = children[node];
    height[node] = below.empty() ? next : 0.5 * (height[below.front()] + height[below.back()]);
    if (below.empty()) next += leaf;
    way.pop_back();
  }
  return height;
}

}  // namespace

std::string plan_tree_svg(const PlanTrace& trace) {
  const std::vector<PlanTrace::TreeNode>& tree = trace.tree;
  const std::vector<double> height = heights(tree);
  int deepest = 0;
  for (const PlanTrace::TreeNode& node : tree) deepest = std::max(deepest, node.depth);
  const auto x = [&](std::size_t k) { return kEdge + kLevel * tree[k].depth; };
  const double width = std::max(2 * kEdge + kLevel * deepest, 620.0);
  const double bottom = *std::max_element(height.begin(), height.end()) + 2 * kEdge;
  std::string svg = fmt::format(
      "<svg xmlns='http://www.w3.org/2000/svg' width='{0:.0f}' height='{1:.0f}' viewBox='0 0 "
      "{0:.0f} {1:.0f}' font-family='sans-serif' font-size='12'><rect width='100%' height='100%' "
      "fill='white'/><text x='{2}' y='18'>{3} belief nodes, {4} steps deep; at {5:.2f} s the plan "
      "is {6:+g} m/s²; value between {7:.2f} and {8:.2f}</text>\n",
      width, bottom, kEdge, tree.size(), deepest, trace.time, trace.action.acceleration,
      tree.front().lower, tree.front().upper);
  double left = kEdge;
  for (const double acceleration : {1.0, 0.0, -1.0}) {
    const Branch branch = branch_of(acceleration);
    svg += fmt::format(
        "<line x1='{0:.0f}' x2='{1:.0f}' y1='36' y2='36' stroke='{2}' stroke-width='1.6' "
        "stroke-dasharray='{3}'/><text x='{4:.0f}' y='40'>{5}</text>\n",
        left, left + 30, branch.colour, branch.dashes, left + 36, branch.words);
    left += 150;
  }
  for (std::size_t k = 1; k < tree.size(); ++k) {
    const auto parent = static_cast<std::size_t>(tree[k].parent);
    const Branch branch = branch_of(tree[k].acceleration);
    svg += fmt::format(
        "<path d='M{:.1f} {:.1f} C{:.1f} {:.1f} {:.1f} {:.1f} {:.1f} {:.1f}' fill='none' "
        "stroke='{}' stroke-dasharray='{}'/>\n",
        x(parent), height[parent], x(parent) + 0.5 * kLevel, height[parent], x(k) - 0.5 * kLevel,
        height[k], x(k), height[k], branch.colour, branch.dashes);
  }
  for (std::size_t k = 0; k < tree.size(); ++k)
    svg += fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='{:.1f}' fill='{}' stroke='#1b1f24'/>\n",
                       x(k), height[k], 0.8 + 4.2 * std::sqrt(tree[k].weight),
                       k == 0 ? "#1b1f24" : "white");
  return svg + "</svg>\n";
}

}  // namespace sumogamma
