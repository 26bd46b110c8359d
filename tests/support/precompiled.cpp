// SPDX-License-Identifier: Apache-2.0
// Nothing: the target that has it carries the headers that all tests share (tests/CMakeLists.txt).
