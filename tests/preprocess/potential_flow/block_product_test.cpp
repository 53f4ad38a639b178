#include "preprocess/potential_flow/solvers/block_product.h"

#include <gtest/gtest.h>

#include <Eigen/Core>

namespace ambient {
namespace {

using Rows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

TEST(BlockProduct, AddsTheBlockAndItsTransposeForAllFieldsAndSizes) {
  for (const int rows : {1, 3, 8, 13})
    for (const int columns : {1, 5, 16})
      for (const int fields : {8, 24}) {
        // Small integers make exact sums.
        const auto numbers = [](Eigen::Index i, Eigen::Index j) {
          return static_cast<float>((7 * i + 5 * j) % 11 - 5);
        };
        const Eigen::MatrixXf block = Eigen::MatrixXf::NullaryExpr(rows, columns, numbers);
        const Rows x = Rows::NullaryExpr(columns, fields, numbers);
        const Rows z = Rows::NullaryExpr(rows, fields, numbers);
        Rows y = Rows::Ones(rows, fields), w = Rows::Ones(columns, fields);
        addBlockProduct({block.data(), rows, columns, 1, rows}, x.data(), fields, y.data());
        addBlockProduct({block.data(), columns, rows, rows, 1}, z.data(), fields, w.data());
        EXPECT_EQ(y, Rows((block * x).array() + 1)) << rows << " " << columns << " " << fields;
        EXPECT_EQ(w, Rows((block.transpose() * z).array() + 1));
      }
}

}  // namespace
}  // namespace ambient
