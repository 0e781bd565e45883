#pragma once

namespace sumogamma {

/// Written by tools/train_walking_model.py on bi_corr_400_b_03, eth, hotel, four clips of DUT
/// (intersection_10, _11, _12, roundabout_10), univ003, uo-050-180-180, uo-070-180-180,
/// uo-100-180-180, uo-180-180-070, uo-180-180-120 and zara1: by feature, at step k it adds k times
/// the first and k^2 / 12 times the second.
inline constexpr double kWalkingCoefficients[13][2] = {
    {0.36331, 0.0026488}, {0.91821, 0.22397},    {0.47134, 0.10623},   {0.10151, -0.26627},
    {0.14714, -0.11062},  {-0.015245, 0.016259}, {0.38278, 0.23825},   {0.2383, -0.50371},
    {0.19528, -0.037527}, {-0.14779, 0.98114},   {0.027776, 0.035085}, {-0.044088, 0.20823},
    {0.31351, -0.088057},
};

}  // namespace sumogamma
