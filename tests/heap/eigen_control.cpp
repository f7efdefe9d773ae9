// SPDX-License-Identifier: Apache-2.0
// Control of Eigen's run-time malloc check: a matrix of run-time size has to end this program.
#include <Eigen/Core>
#include <cstdio>

int main(int arguments, char**) {
  const Eigen::Matrix2f fixed = Eigen::Matrix2f::Constant(static_cast<float>(arguments));
  std::printf("a fixed matrix is fine: %f\n", static_cast<double>(fixed.sum()));
  std::fflush(stdout);
  const Eigen::MatrixXf dynamic = Eigen::MatrixXf::Constant(arguments + 9, arguments + 9, 1.0F);
  std::printf("a dynamic matrix went through unseen: %f\n", static_cast<double>(dynamic.sum()));
}
