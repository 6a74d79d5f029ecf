// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Y. Boykov and V. Kolmogorov, "An experimental comparison of min-cut/max-flow algorithms for energy minimization in
//   vision", IEEE Transactions on Pattern Analysis and Machine Intelligence 26(9), 2004; as implemented in Boost.

#include "base/minimum_cut.hpp"

#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/boykov_kolmogorov_max_flow.hpp>

namespace rhizodont {
namespace {

using Traits = boost::adjacency_list_traits<boost::vecS, boost::vecS, boost::directedS>;
using Descriptor = Traits::edge_descriptor;

struct NodeState {
  boost::default_color_type colour = boost::white_color;
  Descriptor predecessor;
  long distance = 0;
};
struct EdgeState {
  double capacity = 0;
  double residual = 0;
  Descriptor reverse;
};
using Graph = boost::adjacency_list<boost::vecS, boost::vecS, boost::directedS, NodeState, EdgeState>;

void connect(Graph& graph, std::size_t a, std::size_t b, double forward, double backward) {
  const auto there = boost::add_edge(a, b, graph).first;
  const auto back = boost::add_edge(b, a, graph).first;
  graph[there].capacity = forward;
  graph[back].capacity = backward;
  graph[there].reverse = back;
  graph[back].reverse = there;
}

}  // namespace

std::vector<bool> minimum_cut(const std::vector<double>& cost_true, const std::vector<double>& cost_false,
                              const std::vector<CutEdge>& edges) {
  const std::size_t n = cost_true.size();
  const std::size_t source = n;
  const std::size_t sink = n + 1;
  Graph graph(n + 2);
  for (std::size_t i = 0; i < n; ++i) {
    connect(graph, source, i, cost_false[i], 0);  // cut, and so paid, where i ends on the sink's (false) side
    connect(graph, i, sink, cost_true[i], 0);
  }
  for (const CutEdge& e : edges)
    connect(graph, static_cast<std::size_t>(e.a), static_cast<std::size_t>(e.b), e.cost, e.cost);
  boost::boykov_kolmogorov_max_flow(graph, boost::get(&EdgeState::capacity, graph),
                                    boost::get(&EdgeState::residual, graph), boost::get(&EdgeState::reverse, graph),
                                    boost::get(&NodeState::predecessor, graph), boost::get(&NodeState::colour, graph),
                                    boost::get(&NodeState::distance, graph), boost::get(boost::vertex_index, graph),
                                    source, sink);
  std::vector<bool> is_true(n);
  for (std::size_t i = 0; i < n; ++i) is_true[i] = graph[i].colour == boost::black_color;
  return is_true;
}

}  // namespace rhizodont
