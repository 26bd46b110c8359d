// SPDX-License-Identifier: Apache-2.0
// The figures declared here are those of the authors' own implementation, version 1.4a (ArHosekSkyModelData_RGB.h and
// ArHosekSkyModelData_Spectral.h in github.com/mitsuba-renderer/mitsuba-data, sunsky/generation/src, commit 01100fa;
// those of RGB are the same in github.com/mitsuba-renderer/mitsuba, src/emitters/sunsky/skymodeldata.h, commit
// 10af06f3), published under this licence:
//
// This source is published under the following 3-clause BSD license.
//
// Copyright (c) 2012 - 2013, Lukas Hosek and Alexander Wilkie
// All rights reserved.
//
// Redistribution and use in source and binary forms, with or without
// modification, are permitted provided that the following conditions are met:
//
//     * Redistributions of source code must retain the above copyright
//       notice, this list of conditions and the following disclaimer.
//     * Redistributions in binary form must reproduce the above copyright
//       notice, this list of conditions and the following disclaimer in the
//       documentation and/or other materials provided with the distribution.
//     * None of the names of the contributors may be used to endorse or promote
//       products derived from this software without specific prior written
//       permission.
//
// THIS SOFTWARE IS PROVIDED BY THE COPYRIGHT HOLDERS AND CONTRIBUTORS "AS IS" AND
// ANY EXPRESS OR IMPLIED WARRANTIES, INCLUDING, BUT NOT LIMITED TO, THE IMPLIED
// WARRANTIES OF MERCHANTABILITY AND FITNESS FOR A PARTICULAR PURPOSE ARE
// DISCLAIMED. IN NO EVENT SHALL THE COPYRIGHT HOLDERS BE LIABLE FOR ANY
// DIRECT, INDIRECT, INCIDENTAL, SPECIAL, EXEMPLARY, OR CONSEQUENTIAL DAMAGES
// (INCLUDING, BUT NOT LIMITED TO, PROCUREMENT OF SUBSTITUTE GOODS OR SERVICES;
// LOSS OF USE, DATA, OR PROFITS; OR BUSINESS INTERRUPTION) HOWEVER CAUSED AND
// ON ANY THEORY OF LIABILITY, WHETHER IN CONTRACT, STRICT LIABILITY, OR TORT
// (INCLUDING NEGLIGENCE OR OTHERWISE) ARISING IN ANY WAY OUT OF THE USE OF THIS
// SOFTWARE, EVEN IF ADVISED OF THE POSSIBILITY OF SUCH DAMAGE.

#pragma once

namespace treefarm {

/// One channel of the sky in linear Rec. 709. Rows: 6 control points for the elevation of the sun (innermost),
/// turbidities 1 to 10, albedos 0 and 1 of the ground. Columns: the coefficients A, B, C, D, E, F, G, I, H of the
/// paper's equation, in the authors' order, then the mean radiance in W / (m^2 sr): the spectrum integrated against the
/// channel's response.
using HosekWilkieTable = double[2 * 10 * 6][10];

extern const HosekWilkieTable kHosekWilkieRed;
extern const HosekWilkieTable kHosekWilkieGreen;
extern const HosekWilkieTable kHosekWilkieBlue;

/// Irradiance of the sun on a plane perpendicular to it, linear Rec. 709, W / (m^2 nm): by turbidity from 1 to 10, and
/// by elevation from 2 to 89 degrees in steps of 3.
using HosekWilkieSunTable = double[10][30][3];

extern const HosekWilkieSunTable kHosekWilkieSun;

}  // namespace treefarm
