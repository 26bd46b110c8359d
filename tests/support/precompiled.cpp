// SPDX-License-Identifier: Apache-2.0
// Empty: its target provides the headers that all tests share (tests/CMakeLists.txt).
