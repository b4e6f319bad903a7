//! The scenes as functions that a counter calls by name.

use crate::frames::with_flat;
use fixel::Turn;
use fixel_firmware::bench;

macro_rules! scenes {
    ($($name:literal $function:ident $covered:ident $target:ident $draw:expr;)*) => {
        $(
            #[doc = concat!("Draws ", $name, "; returns how many pixels it covers.")]
            #[unsafe(no_mangle)]
            pub(crate) extern "C" fn $function(_frame: u32) -> u32 {
                $target($draw);
                bench::$covered
            }
        )*
        /// Each scene's name and function.
        #[cfg(board = "mps2")]
        pub(crate) const SCENES: &[(&str, extern "C" fn(u32) -> u32)] = &[$(($name, $function)),*];
    };
}

#[cfg(feature = "only-s1")]
scenes! {
    "s1" bench_s1 S1_PIXELS with_flat |frame| bench::s1(Turn::ZERO, frame);
}

#[cfg(not(feature = "only-s1"))]
use crate::deep::with_deep;

#[cfg(not(feature = "only-s1"))]
scenes! {
    "s1" bench_s1 S1_PIXELS with_flat |frame| bench::s1(Turn::ZERO, frame);
    "s1_roll30" bench_s1_roll30 S1_ROLL30_PIXELS with_flat |frame| bench::s1(Turn::from_degrees(30), frame);
    "s1_roll90" bench_s1_roll90 S1_ROLL90_PIXELS with_flat |frame| bench::s1(Turn::from_degrees(90), frame);
    "s1_ground" bench_s1_ground S1_GROUND_PIXELS with_flat bench::s1_ground;
    "s2" bench_s2 S2_PIXELS with_deep bench::s2;
    "s3" bench_s3 S3_PIXELS with_deep bench::s3;
    "s3_tex" bench_s3_tex S3_PIXELS with_deep bench::s3_tex;
}
