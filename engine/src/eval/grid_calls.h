#pragma once
// Checks and decisions of evaluate() that other calls over grids share. T is float or double.

#include "eval/grid_plan_impl.h"
#include "eval/staged_block.h"

namespace tessera { inline namespace abi_0_1 {

/// Checks a plan and outputs for all patches of the set. Returns the highest order of the derivatives that the outputs
/// are made of. Errors: those of evaluate().
template <class T>
Result<int> check_grids(const PatchSet::Impl& set, const GridPlan& plan, const QuantityViews<T>& out);
template <class T>
Result<int> check_grids(const PatchSet::Impl& set, const GridPlan& plan, const QuantityBlocks<T>& out);

/// Whether this many records are written by streaming stores.
template <class T>
bool views_stream(const StageLayout<T>& layout, std::size_t records, Stores stores);
template <class T>
bool blocks_stream(const QuantityBlocks<T>& out, std::size_t records, Stores stores);

/// Returns how many blocks a task takes: all of them if one thread is faster than two.
std::size_t blocks_per_task(const GridPlan::Impl& plan, std::size_t blocks, bool derivatives);

}}  // namespace tessera::abi_0_1
