//! The tables of ISO 286-1 for diameters up to 500 mm, in the layout of the standard: a column per step of diameters.
//!
//! Standard: ISO 286-1, "ISO code system for tolerances on linear sizes, Part 1: Basis of tolerances, deviations and fits": Table 1
//! (standard tolerances), Tables 2 and 3 (fundamental deviations of holes, with Δ), Tables 4 and 5 (of shafts). Its text was not at hand:
//! the values are those that handbooks print. They are tables and not formulas, because the rounding of the standard follows from none.
//!
//! What was checked against what:
//! - every limit of size that follows (IT1 to IT18, a diameter inside and at the end of each step, 21 462 values) against the tables of
//!   `rf-tolerance` (github.com/rf-ghofmockel/rf-tolerance);
//! - 1 628 limits of the common fits against those of `isofits` (github.com/parkergreene/isofits);
//! - each row of grades (IT0 and IT01 too), shafts, holes and Δ against `ITRECHNER` (github.com/rustyoldguy/ITRECHNER);
//! - IT01 to IT18 up to 30 mm (100 values) against a calculator after IS 919-2:1993, IT1 to IT14 and h6 to h12 up to 315 mm (231 values)
//!   against two pages for workshops, shafts `m` to `zc` up to 180 mm (124 values) against Table 15.2 of a textbook, "Machine Drawing";
//! - A13 above 315 mm, E8 above 80 mm, R10 above 18 mm and f9 above 250 mm against ISO 286-2:1988/Cor. 1:2006.
//!
//! Each source has a few cells of its own that another one, and the laws in the tests, contradict; there the value that two have is
//! taken. Two stay open: the hole `X` above 3 mm up to 6 mm is −28 µm as for the shaft (printed so, +28 µm, in three tables of shafts), where
//! two of the sources have −29 µm; `M6` above 250 mm up to 315 mm is −9 µm by the exception of Table 3, as `isofits` has it.

/// Largest diameter of each main step, mm; each step begins above the one before.
pub(super) const STEPS_MM: [f64; 13] = [3.0, 6.0, 10.0, 18.0, 30.0, 50.0, 80.0, 120.0, 180.0, 250.0, 315.0, 400.0, 500.0];

/// Largest diameter of each intermediate step, mm.
#[rustfmt::skip]
pub(super) const FINE_STEPS_MM: [f64; 25] = [
    3.0, 6.0, 10.0, 14.0, 18.0, 24.0, 30.0, 40.0, 50.0, 65.0, 80.0, 100.0, 120.0,
    140.0, 160.0, 180.0, 200.0, 225.0, 250.0, 280.0, 315.0, 355.0, 400.0, 450.0, 500.0,
];

/// Standard tolerance grades, as written.
pub(super) const GRADES: [&str; 20] =
    ["01", "0", "1", "2", "3", "4", "5", "6", "7", "8", "9", "10", "11", "12", "13", "14", "15", "16", "17", "18"];

/// Standard tolerances, tenths of a micrometre: a row per grade, a column per main step.
#[rustfmt::skip]
pub(super) const TOLERANCE: [[i32; 13]; 20] = [
    [3, 4, 4, 5, 6, 6, 8, 10, 12, 20, 25, 30, 40],
    [5, 6, 6, 8, 10, 10, 12, 15, 20, 30, 40, 50, 60],
    [8, 10, 10, 12, 15, 15, 20, 25, 35, 45, 60, 70, 80],
    [12, 15, 15, 20, 25, 25, 30, 40, 50, 70, 80, 90, 100],
    [20, 25, 25, 30, 40, 40, 50, 60, 80, 100, 120, 130, 150],
    [30, 40, 40, 50, 60, 70, 80, 100, 120, 140, 160, 180, 200],
    [40, 50, 60, 80, 90, 110, 130, 150, 180, 200, 230, 250, 270],
    [60, 80, 90, 110, 130, 160, 190, 220, 250, 290, 320, 360, 400],
    [100, 120, 150, 180, 210, 250, 300, 350, 400, 460, 520, 570, 630],
    [140, 180, 220, 270, 330, 390, 460, 540, 630, 720, 810, 890, 970],
    [250, 300, 360, 430, 520, 620, 740, 870, 1000, 1150, 1300, 1400, 1550],
    [400, 480, 580, 700, 840, 1000, 1200, 1400, 1600, 1850, 2100, 2300, 2500],
    [600, 750, 900, 1100, 1300, 1600, 1900, 2200, 2500, 2900, 3200, 3600, 4000],
    [1000, 1200, 1500, 1800, 2100, 2500, 3000, 3500, 4000, 4600, 5200, 5700, 6300],
    [1400, 1800, 2200, 2700, 3300, 3900, 4600, 5400, 6300, 7200, 8100, 8900, 9700],
    [2500, 3000, 3600, 4300, 5200, 6200, 7400, 8700, 10000, 11500, 13000, 14000, 15500],
    [4000, 4800, 5800, 7000, 8400, 10000, 12000, 14000, 16000, 18500, 21000, 23000, 25000],
    [6000, 7500, 9000, 11000, 13000, 16000, 19000, 22000, 25000, 29000, 32000, 36000, 40000],
    [10000, 12000, 15000, 18000, 21000, 25000, 30000, 35000, 40000, 46000, 52000, 57000, 63000],
    [14000, 18000, 22000, 27000, 33000, 39000, 46000, 54000, 63000, 72000, 81000, 89000, 97000],
];

/// Stands where the standard has a dash.
pub(super) const NONE: i32 = i32::MIN;

/// Fundamental deviations of shafts that do not depend on the grade, µm, by letter; a value per main or per intermediate step. For `a` to
/// `h` it is the distance of the upper limit below the nominal diameter, for the others that of the lower limit above it.
#[rustfmt::skip]
pub(super) const SHAFTS: [(&str, &[i32]); 24] = [
    ("a", &[270, 270, 280, 290, 290, 300, 300, 310, 320, 340, 360, 380, 410, 460, 520, 580, 660, 740, 820, 920, 1050, 1200, 1350, 1500, 1650]),
    ("b", &[140, 140, 150, 150, 150, 160, 160, 170, 180, 190, 200, 220, 240, 260, 280, 310, 340, 380, 420, 480, 540, 600, 680, 760, 840]),
    ("c", &[60, 70, 80, 95, 95, 110, 110, 120, 130, 140, 150, 170, 180, 200, 210, 230, 240, 260, 280, 300, 330, 360, 400, 440, 480]),
    ("d", &[20, 30, 40, 50, 65, 80, 100, 120, 145, 170, 190, 210, 230]),
    ("e", &[14, 20, 25, 32, 40, 50, 60, 72, 85, 100, 110, 125, 135]),
    ("f", &[6, 10, 13, 16, 20, 25, 30, 36, 43, 50, 56, 62, 68]),
    ("g", &[2, 4, 5, 6, 7, 9, 10, 12, 14, 15, 17, 18, 20]),
    ("h", &[0; 13]),
    ("k", &[0, 1, 1, 1, 2, 2, 2, 3, 3, 4, 4, 4, 5]),
    ("m", &[2, 4, 6, 7, 8, 9, 11, 13, 15, 17, 20, 21, 23]),
    ("n", &[4, 8, 10, 12, 15, 17, 20, 23, 27, 31, 34, 37, 40]),
    ("p", &[6, 12, 15, 18, 22, 26, 32, 37, 43, 50, 56, 62, 68]),
    ("r", &[10, 15, 19, 23, 23, 28, 28, 34, 34, 41, 43, 51, 54, 63, 65, 68, 77, 80, 84, 94, 98, 108, 114, 126, 132]),
    ("s", &[14, 19, 23, 28, 28, 35, 35, 43, 43, 53, 59, 71, 79, 92, 100, 108, 122, 130, 140, 158, 170, 190, 208, 232, 252]),
    ("t", &[NONE, NONE, NONE, NONE, NONE, NONE, 41, 48, 54, 66, 75, 91, 104, 122, 134, 146, 166, 180, 196, 218, 240, 268, 294, 330, 360]),
    ("u", &[18, 23, 28, 33, 33, 41, 48, 60, 70, 87, 102, 124, 144, 170, 190, 210, 236, 258, 284, 315, 350, 390, 435, 490, 540]),
    ("v", &[NONE, NONE, NONE, NONE, 39, 47, 55, 68, 81, 102, 120, 146, 172, 202, 228, 252, 284, 310, 340, 385, 425, 475, 530, 595, 660]),
    ("x", &[20, 28, 34, 40, 45, 54, 64, 80, 97, 122, 146, 178, 210, 248, 280, 310, 350, 385, 425, 475, 525, 590, 660, 740, 820]),
    ("y", &[NONE, NONE, NONE, NONE, NONE, 63, 75, 94, 114, 144, 174, 214, 254, 300, 340, 380, 425, 470, 520, 580, 650, 730, 820, 920, 1000]),
    ("z", &[26, 35, 42, 50, 60, 73, 88, 112, 136, 172, 210, 258, 310, 365, 415, 465, 520, 575, 640, 710, 790, 900, 1000, 1100, 1250]),
    ("za", &[32, 42, 52, 64, 77, 98, 118, 148, 180, 226, 274, 335, 400, 470, 535, 600, 670, 740, 820, 920, 1000, 1150, 1300, 1450, 1600]),
    ("zb", &[40, 50, 67, 90, 108, 136, 160, 200, 242, 300, 360, 445, 525, 620, 700, 780, 880, 960, 1050, 1200, 1300, 1500, 1650, 1850, 2100]),
    ("zc", &[60, 80, 97, 130, 150, 188, 218, 274, 325, 405, 480, 585, 690, 800, 900, 1000, 1150, 1250, 1350, 1550, 1700, 1900, 2100, 2400, 2600]),
    // Symmetric about the nominal diameter: no fundamental deviation. Kept last, so that all letters stand in one list.
    ("js", &[0; 13]),
];

/// Distance of the lower limit of a shaft `j5` or `j6`, `j7`, `j8` below the nominal diameter, µm, by intermediate steps.
#[rustfmt::skip]
pub(super) const SHAFT_J: [[i32; 25]; 3] = [
    [2, 2, 2, 3, 3, 4, 4, 5, 5, 7, 7, 9, 9, 11, 11, 11, 13, 13, 13, 16, 16, 18, 18, 20, 20],
    [4, 4, 5, 6, 6, 8, 8, 10, 10, 12, 12, 15, 15, 18, 18, 18, 21, 21, 21, 26, 26, 28, 28, 32, 32],
    [6, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE],
];

/// Distance of the upper limit of a hole `J6`, `J7`, `J8` above the nominal diameter, µm, by main steps.
pub(super) const HOLE_J: [[i32; 13]; 3] = [
    [2, 5, 5, 6, 8, 10, 13, 16, 18, 22, 25, 29, 33],
    [4, 6, 8, 10, 12, 14, 18, 22, 26, 30, 36, 39, 43],
    [6, 10, 12, 15, 20, 24, 28, 34, 41, 47, 55, 60, 66],
];

/// Δ of the holes `K` to `ZC`, tenths of a micrometre: a row per grade from IT3 to IT8, a column per main step.
pub(super) const DELTA: [[i32; 13]; 6] = [
    [0, 10, 10, 10, 15, 15, 20, 20, 30, 30, 40, 40, 50],
    [0, 15, 15, 20, 20, 30, 30, 40, 40, 40, 40, 50, 50],
    [0, 10, 20, 30, 30, 40, 50, 50, 60, 60, 70, 70, 70],
    [0, 30, 30, 30, 40, 50, 60, 70, 70, 90, 90, 110, 130],
    [0, 40, 60, 70, 80, 90, 110, 130, 150, 170, 200, 210, 230],
    [0, 60, 70, 90, 120, 140, 160, 190, 230, 260, 290, 320, 340],
];
