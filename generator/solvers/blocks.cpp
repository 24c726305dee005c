#include "generator/solvers/blocks.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <utility>

#include "generator/base/budget.hpp"

namespace hamgen {

namespace {

// Tarjan's algorithm with an explicit stack: chains may be thousands of nodes long.
class Tarjan {
 public:
  Tarjan(const std::vector<int>& nodes, const Dependency& depends) : nodes_(nodes) {
    for (const int i : nodes) {
      for (const int j : nodes) {
        if (i != j && depends(i, j)) successors_[i].push_back(j);
      }
    }
  }

  std::vector<std::vector<int>> run() {
    for (const int node : nodes_) {
      if (!index_.contains(node)) visit(node);
    }
    return components_;
  }

 private:
  struct Frame {
    int node;
    std::size_t next;
  };

  void visit(int root) {
    std::vector<Frame> frames{{root, 0}};
    open(root);
    while (!frames.empty()) {
      Frame& frame = frames.back();
      const std::vector<int>& out = successors_[frame.node];
      if (frame.next < out.size()) {
        const int target = out[frame.next++];
        if (!index_.contains(target)) {
          open(target);
          frames.push_back({target, 0});
        } else if (on_stack_[target]) {
          low_[frame.node] = std::min(low_[frame.node], index_[target]);
        }
        continue;
      }
      const int node = frame.node;
      frames.pop_back();
      if (!frames.empty())
        low_[frames.back().node] = std::min(low_[frames.back().node], low_[node]);
      if (low_[node] == index_[node]) close(node);
    }
  }

  void open(int node) {
    index_[node] = low_[node] = counter_++;
    stack_.push_back(node);
    on_stack_[node] = true;
  }

  void close(int node) {
    std::vector<int> component;
    int member = -1;
    do {
      member = stack_.back();
      stack_.pop_back();
      on_stack_[member] = false;
      component.push_back(member);
    } while (member != node);
    std::ranges::sort(component);
    components_.push_back(std::move(component));
  }

  const std::vector<int>& nodes_;
  std::map<int, std::vector<int>> successors_;
  std::map<int, int> index_, low_;
  std::map<int, bool> on_stack_;
  std::vector<int> stack_;
  std::vector<std::vector<int>> components_;
  int counter_ = 0;
};

}  // namespace

std::vector<std::vector<int>> strongly_connected_components(const std::vector<int>& nodes,
                                                            const Dependency& depends) {
  return Tarjan(nodes, depends).run();
}

Dependency tabulated(const std::vector<int>& nodes, const Dependency& depends) {
  if (nodes.empty()) return depends;
  const std::size_t size = static_cast<std::size_t>(*std::ranges::max_element(nodes)) + 1;
  std::vector<std::vector<bool>> table(size, std::vector<bool>(size));
  for (const int i : nodes) {
    for (const int j : nodes)
      table[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = depends(i, j);
  }
  return [table = std::make_shared<const std::vector<std::vector<bool>>>(std::move(table))](int i,
                                                                                            int j) {
    return (*table)[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
  };
}

std::vector<int> tear(const std::vector<int>& preference, const Dependency& depends,
                      const std::function<bool(int)>& may_self) {
  std::vector<int> torn;
  for (const int candidate : preference) {
    if (depends(candidate, candidate) && !may_self(candidate)) continue;
    std::vector<int> trial = torn;
    trial.push_back(candidate);
    spend(Resource::work, 0.1 * static_cast<double>(trial.size() * trial.size()));
    if (strongly_connected_components(trial, depends).size() == trial.size()) torn = trial;
  }
  std::ranges::sort(torn);
  std::vector<int> ordered;
  for (const auto& component : strongly_connected_components(torn, depends)) {
    ordered.push_back(component.front());
  }
  return ordered;
}

}  // namespace hamgen
