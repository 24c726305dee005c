#include "generator/base/fixed_blocks.hpp"

#include <algorithm>

namespace hamgen {

namespace {

constexpr FixedBlock kCppBlocks[] = {
    {"step_report", "StepReport"},
    {kVocabulary, "magnitude largest epsilon"},
    {"two_sum", "two_sum"},
    {"sum_with_rest", "two_sum_with_rest"},
    {"collected_sum", "collect"},
    {"product_error", "product_error"},
    {"difference_error", "difference_error"},
    {"sums", "sum_of lengths_of squares_of"},
    {"dense_matrix", "DenseMatrix"},
    {"symmetric_matrix", "SymmetricMatrix"},
    {"diagonal_matrix", "DiagonalMatrix"},
    {"band_matrix", "BandMatrix"},
    {"symmetric_band_matrix", "SymmetricBandMatrix"},
    {"element_order", "ElementOrder"},
    {"border_order", "BorderOrder"},
    {"border", "Border"},
    {"bordered_matrix", "BorderedMatrix"},
    {"reordered_matrix", "ReorderedMatrix"},
    {"eigen_dense_matrix", "EigenDenseMatrix", true},
    {"eigen_sparse_matrix", "EigenSparseMatrix", true},
    {"inverse", "invert"},
    {"verdict", "Verdict"},
    {"newton_rule", "NewtonRule"},
    {"newton_rule_of_many", "NewtonRuleOfMany"},
    {"newton_rule_with_matrix", "NewtonRuleWithMatrix"},
    {"waiting_newton_rule", "WaitingNewtonRule"},
    {"fixed_point_rule", "FixedPointRule Distance"},
    {"contraction_rule", "ContractionRule"},
#include "generator/base/fixed_point_blocks.inc"
    {"simplified_newton_rule", "SimplifiedNewtonRule"},
    {"linear_rule", "LinearRule"},
    {"refinement", "Refinement"},
    {"history", "History"},
    {"forget", "forget"},
    {"ahead", "extrapolate_twice"},
    {.name = "bracketed_root", .defines = "bracketed_root", .events = true},
    {.name = "crossings", .defines = "cubic_between find_crossings", .events = true},
    {.name = "crossing_list", .defines = "CrossingList", .events = true},
};

constexpr FixedBlock kLaneBlocks[] = {
    {"lane_vectors", "VectorOf MaskOf BitsOf"},
    {"lane_mask", "LaneMask any all"},
    {"pack", "Pack lanes_of select lane_abs lane_sqrt"},
    {.name = "lane_distance", .defines = "add_lanes", .helpers = "total_of"},
    {"lane_refinement", "RefinementInLanes"},
    {.name = "lane_stages",
     .defines = "collect_stages",
     .helpers = "half_of collected collect_halves"},
    {"lane_pairs", "Pair"},
    {"lane_sine", "lane_sin lane_cos lane_tan"},
    {.name = "lane_exponential",
     .defines = "lane_exp lane_sinh lane_cosh lane_tanh",
     .helpers = "exponential clamped"},
    {.name = "lane_logarithm",
     .defines = "lane_log lane_asinh lane_acosh lane_atanh",
     .helpers = "mantissa_of"},
    {"lane_power", "lane_pow"},
    {"lane_arcs", "lane_atan lane_atan2 lane_asin lane_acos"},
    {"lane_library", "library"},
    {kVocabulary, "Real Mask magnitude largest epsilon"},
    {"two_sum", "two_sum"},
    {"sum_with_rest", "two_sum_with_rest"},
    {"collected_sum", "collect"},
    {"lane_product_error", "product_error"},
    {"lane_difference_error", "difference_error"},
    {"sums", "sum_of lengths_of squares_of"},
    {"lane_step",
     "StepReport require_finite stop_failed astray_lanes add_substep take_lanes move_lanes "
     "collect_lanes"},
    {"lane_turn", "Turn Iteration end_iteration"},
    {"lane_dense_matrix", "DenseMatrix"},
    {"lane_symmetric_matrix", "SymmetricMatrix"},
    {"lane_diagonal_matrix", "DiagonalMatrix"},
    {.name = "lane_band_matrix", .defines = "BandMatrix", .helpers = "BandStorage BandElimination"},
    {"lane_symmetric_band_matrix", "SymmetricBandMatrix"},
    {"lane_sparse_matrix", "SparseMatrix"},
    {"element_order", "ElementOrder"},
    {"border_order", "BorderOrder"},
    {"border", "Border"},
    {"lane_bordered_matrix", "BorderedMatrix"},
    {"lane_reordered_matrix", "ReorderedMatrix"},
    {"lane_kept_matrix", "KeptMatrix"},
    {"lane_inverse", "invert"},
    {"lane_newton_rule", "NewtonRule"},
    {"lane_newton_rule_of_many", "NewtonRuleOfMany"},
    {"lane_newton_rule_with_matrix", "NewtonRuleWithMatrix"},
    {"lane_waiting_newton_rule", "WaitingNewtonRule"},
    {.name = "lane_fixed_point_rule", .defines = "FixedPointRule Distance", .helpers = "Judgement"},
    {"lane_contraction_rule", "ContractionRule"},
#include "generator/base/fixed_point_lane_blocks.inc"
    {"lane_simplified_newton_rule", "SimplifiedNewtonRule"},
    {"lane_linear_rule", "LinearRule"},
    {"lane_each_refinement", "Refinement"},
    {"lane_history", "History forget"},
};

constexpr FixedBlock kCBlocks[] = {
    {"step_report", "StepReport"},
    {"two_sum", "two_sum"},
    {"sum_with_rest", "two_sum_with_rest"},
    {"collected_sum", "collect"},
    {kEpsilon, "epsilon"},
    {"product_error", "product_error"},
    {"difference_error", "difference_error"},
    {kVocabulary, "magnitude largest"},
    {"newton_rule",
     "Verdict go_on done failed NewtonRule NewtonRule_of_power NewtonRule_power NewtonRule_begin "
     "NewtonRule_felt NewtonRule_relative NewtonRule_is_lost_in NewtonRule_learn NewtonRule_judge "
     "NewtonRule_is_in_reach NewtonRule_is_still "
     "NewtonRule_size_of NewtonRule_know NewtonRule_follow "
     "NewtonRule_of_each "
     "NewtonRule_check"},
};

}  // namespace

std::span<const FixedBlock> cpp_blocks() { return kCppBlocks; }
std::span<const FixedBlock> lane_blocks() { return kLaneBlocks; }
std::span<const FixedBlock> pack_blocks() {
  const auto* const end = std::ranges::find(kLaneBlocks, kVocabulary, &FixedBlock::name);
  return {std::begin(kLaneBlocks), end};
}
std::span<const FixedBlock> c_blocks() { return kCBlocks; }

namespace {

// Whether one of the words of the list is what the predicate asks for.
template <class Predicate>
bool any_word(std::string_view list, Predicate is_wanted) {
  while (!list.empty()) {
    const std::string_view word = list.substr(0, list.find(' '));
    if (!word.empty() && is_wanted(word)) return true;
    list.remove_prefix(std::min(word.size() + 1, list.size()));
  }
  return false;
}

std::vector<std::string> words_in(std::string_view list) {
  std::vector<std::string> names;
  any_word(list, [&](std::string_view word) {
    names.emplace_back(word);
    return false;
  });
  return names;
}

}  // namespace

std::vector<std::string> names_of(const FixedBlock& block) { return words_in(block.defines); }
std::vector<std::string> helpers_of(const FixedBlock& block) { return words_in(block.helpers); }

bool defines(const FixedBlock& block, std::string_view word) {
  return any_word(block.defines, [&](std::string_view each) { return each == word; });
}

bool is_defined(std::span<const FixedBlock> blocks, std::string_view word) {
  return std::ranges::any_of(blocks, [&](const FixedBlock& block) { return defines(block, word); });
}

}  // namespace hamgen
