//! The promise: each pixel format holds what it is given to half a step of its channel, blends to half a step, and shows every
//! surface as 8 bits a channel show it, to half a step for each time that it rounds.

#![allow(clippy::float_arithmetic, reason = "only the crate is to do without")]

use crate::common;

use common::for_all;
use common::scenes::{Draw, LIGHTS, TEXELS, draw, meshes};
use fixel::embedded_graphics::pixelcolor::raw::RawU16;
use fixel::embedded_graphics::pixelcolor::{Bgr565, Bgr888, Gray8, Rgb565, Rgb666, Rgb888};
use fixel::embedded_graphics::prelude::*;
use fixel::material::{Kind, LayerIn, LitKind};
use fixel::num::{I12F4, I16F16, U1F31, U8F8};
use fixel::{
    Background, Band, BigEndian, BlendFormat, Cull, Depth16, Fog, Gradient, Mask, Material, NoDepth,
    PixelFormat, ScreenVertex, Surface, Texture, draw_triangle,
};
use proptest::prelude::*;

/// A format whose words say what they show.
trait Shown: BlendFormat {
    /// The greatest levels of the channels; a grey has one.
    const MOST: &'static [f64];
    /// Its levels.
    fn levels(word: Self::Word) -> Vec<f64>;
    /// The levels, as real numbers, that red, green and blue of 0 … 1 are.
    fn exact(rgb: [f64; 3]) -> Vec<f64> {
        rgb.iter().zip(Self::MOST).map(|(channel, most)| channel * most).collect()
    }
}

macro_rules! shown {
    ($($format:ty: $color:ident;)*) => {$(
        impl Shown for $format {
            const MOST: &'static [f64] = &[$color::MAX_R as f64, $color::MAX_G as f64, $color::MAX_B as f64];

            fn levels(word: Self::Word) -> Vec<f64> {
                let color = <$format as PixelFormat>::decode(word);
                [color.r(), color.g(), color.b()].map(f64::from).to_vec()
            }
        }
    )*};
}

shown! {
    Rgb565: Rgb565; BigEndian<Rgb565>: Rgb565; Bgr565: Bgr565; BigEndian<Bgr565>: Bgr565; Rgb666: Rgb666; Rgb888: Rgb888;
    Bgr888: Bgr888;
}

impl Shown for Gray8 {
    const MOST: &'static [f64] = &[255.0];

    fn levels(word: u8) -> Vec<f64> {
        vec![f64::from(<Self as PixelFormat>::decode(word).luma())]
    }

    fn exact([red, green, blue]: [f64; 3]) -> Vec<f64> {
        vec![255.0 * (0.299 * red + 0.587 * green + 0.114 * blue)]
    }
}

/// The largest distance from exact, in steps.
fn off<F: Shown>(word: F::Word, rgb: [f64; 3]) -> f64 {
    let exact = F::exact(rgb);
    F::levels(word).iter().zip(&exact).map(|(level, exact)| (level - exact).abs()).fold(0.0, f64::max)
}

/// Red, green and blue of 0 … 1 of an RGB565 number.
fn of_565(bits: u16) -> [f64; 3] {
    [f64::from(bits >> 11) / 31.0, f64::from(bits >> 5 & 63) / 63.0, f64::from(bits & 31) / 31.0]
}

/// The largest distances of RGB565 numbers, of 8-bit channels and of greys, over all of them; of channels each with others of the
/// other two.
fn largest<F: Shown>() -> [f64; 3] {
    let of_texels = (0..=u16::MAX).map(|bits| off::<F>(F::rgb565(bits), of_565(bits)));
    let of_channels = (0..3 * 256 * 16).map(|i: usize| {
        let level = (i / 3 % 256) as u8;
        let other = (i / 768) as u8;
        let mut rgb = [other.wrapping_mul(17) ^ level, other.wrapping_mul(29), level.rotate_left(3) ^ other];
        rgb[i % 3] = level;
        off::<F>(F::rgb888(rgb[0], rgb[1], rgb[2]), rgb.map(|channel| f64::from(channel) / 255.0))
    });
    let of_grays = (0..=255_u8).map(|level| off::<F>(F::gray(level), [f64::from(level) / 255.0; 3]));
    [of_texels.fold(0.0, f64::max), of_channels.fold(0.0, f64::max), of_grays.fold(0.0, f64::max)]
}

#[test]
fn every_format_is_the_nearest_of_all_colors() {
    let all = [
        ("Rgb565", largest::<Rgb565>()),
        ("BigEndian<Rgb565>", largest::<BigEndian<Rgb565>>()),
        ("Bgr565", largest::<Bgr565>()),
        ("BigEndian<Bgr565>", largest::<BigEndian<Bgr565>>()),
        ("Rgb666", largest::<Rgb666>()),
        ("Rgb888", largest::<Rgb888>()),
        ("Bgr888", largest::<Bgr888>()),
        ("Gray8", largest::<Gray8>()),
    ];
    for (name, largest) in all {
        println!("{name}: {largest:.4?} steps off for RGB565, 8-bit channels, greys");
        // Luma is exact to 1/1000 of a step.
        assert!(largest.into_iter().all(|off| off <= 0.5001), "{name}: {largest:?}");
    }
}

fn light_is_nearest<F: Shown>(name: &str) {
    let mut worst = 0.0_f64;
    for texel in 0..64_u16 {
        for light in 0..=255_u8 {
            let bits = (texel & 31) << 11 | texel << 5 | (31 - texel / 2);
            let lights = [light, light.wrapping_mul(3), 255 - light];
            // Green in any light with red and blue in others.
            for lights in [[light; 3], lights, [lights[1], light, lights[2]]] {
                let [red, green, blue] = of_565(bits);
                let [of_red, of_green, of_blue] = lights.map(|light| f64::from(light) / 255.0);
                let word = F::lit(bits, lights.map(u32::from));
                worst = worst.max(off::<F>(word, [red * of_red, green * of_green, blue * of_blue]));
            }
        }
    }
    println!("{name}: lit texels are {worst:.4} steps off");
    assert!(worst <= 0.501, "{name}: {worst}");
    for bits in 0..=u16::MAX {
        assert!(
            F::levels(F::lit(bits, [255; 3])) == F::levels(F::rgb565(bits)),
            "{name}: full light changes {bits:x}"
        );
        assert!(
            F::levels(F::lit(bits, [0; 3])).iter().all(|level| *level == 0.0),
            "{name}: {bits:x} in the dark"
        );
    }
}

#[test]
fn lit_texels_are_the_nearest_of_every_format_in_all_lights() {
    light_is_nearest::<Rgb565>("Rgb565");
    light_is_nearest::<BigEndian<Rgb565>>("BigEndian<Rgb565>");
    light_is_nearest::<Bgr565>("Bgr565");
    light_is_nearest::<BigEndian<Bgr565>>("BigEndian<Bgr565>");
    light_is_nearest::<Rgb666>("Rgb666");
    light_is_nearest::<Rgb888>("Rgb888");
    light_is_nearest::<Bgr888>("Bgr888");
    light_is_nearest::<Gray8>("Gray8");
}

#[test]
fn colors_keep_their_bits_and_words_have_the_order_of_the_wire() {
    for bits in 0..1_u32 << 18 {
        let color = Rgb666::new((bits >> 12) as u8, (bits >> 6 & 63) as u8, (bits & 63) as u8);
        let word = <Rgb666 as PixelFormat>::encode(color);
        assert_eq!(<Rgb666 as PixelFormat>::decode(word), color);
        assert_eq!(word, [color.r() << 2, color.g() << 2, color.b() << 2]);
    }
    for bits in 0..=u16::MAX {
        let color = Bgr565::from(RawU16::new(bits));
        assert_eq!(<Bgr565 as PixelFormat>::encode(color), bits);
        assert_eq!(<Bgr565 as PixelFormat>::decode(bits), color);
        assert_eq!(<BigEndian<Bgr565> as PixelFormat>::encode(color).to_ne_bytes(), bits.to_be_bytes());
        let [red, green, blue] = [color.r(), color.g(), color.b()].map(u16::from);
        assert_eq!(<Bgr565 as PixelFormat>::rgb565(red << 11 | green << 5 | blue), bits);
    }
    for level in 0..=255_u8 {
        let (a, b) = (level.wrapping_mul(7), !level);
        let [rgb, bgr] = [[level, a, b], [b, a, level]];
        assert_eq!(<Rgb888 as PixelFormat>::encode(Rgb888::new(level, a, b)), rgb);
        assert_eq!(<Rgb888 as PixelFormat>::decode(rgb), Rgb888::new(level, a, b));
        assert_eq!(<Bgr888 as PixelFormat>::encode(Bgr888::new(level, a, b)), bgr);
        assert_eq!(<Bgr888 as PixelFormat>::decode(bgr), Bgr888::new(level, a, b));
        assert_eq!(<Gray8 as PixelFormat>::encode(Gray8::new(level)), level);
        assert_eq!(<Gray8 as PixelFormat>::decode(level), Gray8::new(level));
    }
    let mut pixels = [[0; 3]; 2];
    let mut band = Band::<Bgr888, NoDepth>::new(Size::new(2, 1), &mut pixels, &mut []).expect("a band");
    let Ok(()) = band.fill_solid(&band.bounding_box(), Bgr888::new(1, 2, 3));
    assert_eq!(band.as_bytes(), [3, 2, 1, 3, 2, 1]);
}

/// Checks the formulas over pairs of a channel's levels and opacities; `word` makes a word of three levels.
fn formulas_hold<F: Shown>(name: &str, word: impl Fn([u8; 3]) -> F::Word, all: bool) {
    let most = F::MOST[0] as u8;
    let few = [0, 1, 2, 3, 64, 101, 126, 127, 128, 129, 200, 253, 254, 255];
    let opacities = if all { (0..=255).collect() } else { few.to_vec() };
    let near = |levels: Vec<f64>, exact: f64, what: &str| {
        let distance = (levels[0] - exact).abs();
        assert!(distance <= 0.5, "{name}: {what} is {}, not {exact}", levels[0]);
    };
    for (t, s) in (0..=most).flat_map(|t| (0..=most).map(move |s| (t, s))) {
        let (target, source) = (word([t, s ^ 5 & most, t]), word([s, t ^ 9 & most, t / 2]));
        let [real_t, real_s, m] = [t, s, most].map(f64::from);
        near(F::levels(F::multiply(target, source)), real_t * real_s / m, "multiply");
        for &a in &opacities {
            let alpha = f64::from(a) / 255.0;
            near(F::levels(F::over(target, source, a)), real_s * alpha + real_t * (1.0 - alpha), "over");
            near(F::levels(F::add(target, source, a)), (real_t + real_s * alpha).min(m), "add");
        }
        let levels = F::levels(source);
        assert_eq!(F::levels(F::over(target, source, 255)), levels);
        assert_eq!(F::levels(F::add(source, word([0; 3]), 255)), levels);
        assert_eq!(F::levels(F::multiply(source, F::rgb565(0xffff))), levels);
    }
}

#[test]
fn blends_are_within_half_a_step_of_their_formulas_in_every_format() {
    formulas_hold::<Rgb666>("Rgb666", |levels| levels.map(|level| level << 2), true);
    formulas_hold::<Rgb888>("Rgb888", |levels| levels, false);
    formulas_hold::<Bgr888>("Bgr888", |[red, green, blue]| [blue, green, red], false);
    formulas_hold::<Gray8>("Gray8", |levels| levels[0], false);
    let bgr = |[red, green, blue]: [u8; 3]| Bgr565::new(red & 31, green & 63, blue & 31).into_storage();
    formulas_hold::<Bgr565>("Bgr565", bgr, true);
}

/// How far the colours of a triangle between its corners are from exact at most, in steps, where all three are equally far away: so
/// exact is linear on the screen.
fn gouraud_is_off<F: Shown>(corners: &[([i16; 2], [u16; 3]); 3]) -> f64 {
    const SIZE: [usize; 2] = [90, 32];
    let mut pixels = vec![F::rgb565(0); SIZE[0] * SIZE[1]];
    let mut depth = vec![0; SIZE[0] * SIZE[1]];
    let size = Size::new(SIZE[0] as u32, SIZE[1] as u32);
    let mut band = Band::<F, Depth16>::new(size, &mut pixels, &mut depth).expect("a band");
    let vertices = corners.map(|([x, y], color)| ScreenVertex {
        x: I12F4::from_bits(x),
        y: I12F4::from_bits(y),
        q: U1F31::from_num(0.5),
        u: I16F16::ZERO,
        v: I16F16::ZERO,
        color: color.map(U8F8::from_bits),
    });
    draw_triangle(&vertices, Cull::None, &Material::gouraud(), &mut band).expect("within range");
    let place = corners.map(|(place, _)| place.map(|at| f64::from(at) / 16.0));
    let area = |[a, b, c]: [[f64; 2]; 3]| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    let (whole, [a, b, c]) = (area(place), place);
    let mut worst = 0.0_f64;
    for (i, word) in pixels.iter().enumerate().filter(|(i, _)| depth[*i] != 0) {
        let at = [(i % SIZE[0]) as f64 + 0.5, (i / SIZE[0]) as f64 + 0.5];
        let weights = [area([at, b, c]), area([a, at, c]), area([a, b, at])].map(|part| part / whole);
        let rgb = core::array::from_fn(|channel| {
            let levels = corners.map(|(_, color)| f64::from(color[channel]) / 256.0);
            (weights[0] * levels[0] + weights[1] * levels[1] + weights[2] * levels[2]) / 255.0
        });
        worst = worst.max(off::<F>(*word, rgb));
    }
    worst
}

#[test]
fn colors_between_vertices_are_the_nearest_in_formats_of_few_bits_in_4_500_triangles() {
    /// Channels are packed with 8 fraction bits. On a row of 32 pixels they come to be 1/8 of 1/255 off, and the plane is off by 1/256.
    fn bound(most: f64) -> f64 {
        0.5 + most / 255.0 * (1.0 / 8.0 + 1.0 / 128.0)
    }
    let corner = |across: core::ops::Range<i16>| {
        let channel = prop_oneof![(0..=255_u16).prop_map(|level| level << 8), 0..=0xff00_u16];
        (prop::array::uniform2(across), prop::array::uniform3(channel))
    };
    // The small ones, and those with long rows.
    for (cases, across) in [(1_000, 0..500), (500, -100..1500)] {
        for_all("Gouraud", cases, prop::array::uniform3(corner(across)), |corners| {
            for (name, off, most) in [
                ("Rgb565", gouraud_is_off::<Rgb565>(&corners), 63.0),
                ("Bgr565", gouraud_is_off::<Bgr565>(&corners), 63.0),
                ("Rgb666", gouraud_is_off::<Rgb666>(&corners), 63.0),
            ] {
                prop_assert!(off <= bound(most), "{name}: {off} steps off");
            }
            Ok(())
        });
    }
}

#[test]
fn a_color_that_does_not_change_is_that_of_its_format() {
    fn check<F: Shown>() {
        for level in 0..=255_u16 {
            let color = [level, 255 - level, level ^ 0x5a].map(|level| level << 8);
            let corners = [[0, 0], [480, 16], [32, 400]].map(|place| (place, color));
            assert!(gouraud_is_off::<F>(&corners) <= 0.5001, "{level}");
            let far = corners.map(|(place, color)| (place.map(|at| at * 3), color));
            assert!(gouraud_is_off::<F>(&far) <= 0.5001, "{level}");
        }
    }
    check::<Rgb565>();
    check::<BigEndian<Rgb565>>();
    check::<Bgr565>();
    check::<Rgb666>();
    check::<Rgb888>();
    check::<Bgr888>();
    check::<Gray8>();
}

/// 8 bits a channel, drawn as a format is whose finest channel has 6, and that [keeps](PixelFormat::keep) what a pass leaves or does not:
/// the path along a row depends on that, and where between two texels it changes.
struct Wide<const KEEPS: bool>;

/// A word, and what a pass left in it.
#[derive(Clone, Copy)]
struct WideWord {
    rgb: [u8; 3],
    kept: u16,
}

impl WideWord {
    fn new(rgb: [u8; 3]) -> Self {
        Self { rgb, kept: 0 }
    }
}

impl<const KEEPS: bool> PixelFormat for Wide<KEEPS> {
    type Word = WideWord;
    type Color = Rgb888;
    const COLOR_STEP: u8 = 4;
    const KEEPS: bool = KEEPS;

    fn encode(color: Rgb888) -> WideWord {
        WideWord::new(Rgb888::encode(color))
    }

    fn decode(word: WideWord) -> Rgb888 {
        Rgb888::decode(word.rgb)
    }

    fn rgb565(bits: u16) -> WideWord {
        WideWord { rgb: Rgb888::rgb565(bits), kept: bits }
    }

    fn rgb888(red: u8, green: u8, blue: u8) -> WideWord {
        WideWord::new([red, green, blue])
    }

    fn lit(texel: u16, light: [u32; 3]) -> WideWord {
        WideWord::new(Rgb888::lit(texel, light))
    }

    fn kept(word: WideWord) -> u16 {
        word.kept
    }

    fn texel(word: WideWord) -> u16 {
        word.kept
    }
}

impl<const KEEPS: bool> BlendFormat for Wide<KEEPS> {
    fn over(target: WideWord, source: WideWord, alpha: u8) -> WideWord {
        WideWord::new(Rgb888::over(target.rgb, source.rgb, alpha))
    }

    fn add(target: WideWord, source: WideWord, alpha: u8) -> WideWord {
        WideWord::new(Rgb888::add(target.rgb, source.rgb, alpha))
    }

    fn multiply(target: WideWord, source: WideWord) -> WideWord {
        WideWord::new(Rgb888::multiply(target.rgb, source.rgb))
    }
}

static MASK: [u8; 32] = [0b1100_1110; 32];

/// A surface, how often a pixel of it is rounded, and whether channels meet in it that have to be apart: which a grey has not.
struct Rounded<F: PixelFormat> {
    name: String,
    surface: Surface<'static, F, Depth16>,
    times: f64,
    is_of_channels: bool,
}

fn in_layers<F: BlendFormat, K: Kind>(name: &str, material: Material<'static, K>, to: &mut Vec<Rounded<F>>) {
    fn push<F: BlendFormat>(
        to: &mut Vec<Rounded<F>>,
        name: String,
        surface: Surface<'static, F, Depth16>,
        times: f64,
        is_of_channels: bool,
    ) {
        to.push(Rounded { name, surface, times, is_of_channels });
    }
    fn surface<F: BlendFormat, K: Kind, L: LayerIn<F>>(
        material: Material<'static, K, fixel::QuarterPixel, L>,
    ) -> Surface<'static, F, Depth16> {
        material.surface()
    }
    push(to, name.to_owned(), surface(material), 1.0, false);
    push(to, format!("{name}, screen door"), surface(material.alpha(140).screen_door()), 1.0, false);
    // What is there was rounded, the colour is, and what they make.
    push(to, format!("{name}, over"), surface(material.alpha(90)), 2.0, false);
    push(to, format!("{name}, added"), surface(material.additive().alpha(150)), 3.0, true);
    push(to, format!("{name}, multiplied"), surface(material.multiply()), 3.0, true);
}

fn in_light<F: BlendFormat, K: LitKind>(
    name: &str,
    material: Material<'static, K>,
    to: &mut Vec<Rounded<F>>,
) {
    in_layers(name, material, to);
    in_layers(&format!("{name} in light"), material.lit(), to);
}

/// Every kind of surface.
fn all<F: BlendFormat>() -> Vec<Rounded<F>> {
    let texture = Texture::new(&TEXELS, 4, 4);
    let mut all = Vec::new();
    in_light("flat", Material::flat(Rgb565::CSS_GOLD), &mut all);
    in_light("Gouraud", Material::gouraud(), &mut all);
    in_light("textured", Material::textured(&texture), &mut all);
    in_light("clamped", Material::clamped(&texture), &mut all);
    in_light("mirrored", Material::mirrored(&texture), &mut all);
    let cut_out = Material::textured(&texture).masked(&Mask::new(&MASK, 4, 4));
    let textured = Material::textured(&texture).texture_scale(2).lit().faceted().two_sided();
    let once = [
        ("cut out", cut_out.surface()),
        ("cut out in light", cut_out.lit().surface()),
        ("exact, in light on faces", textured.exact().surface()),
        ("affine, in light on faces", textured.affine().surface()),
        ("Gouraud, exact", Material::gouraud().lit().exact().surface()),
    ];
    for (name, surface) in once {
        all.push(Rounded { name: name.to_owned(), surface, times: 1.0, is_of_channels: false });
    }
    all
}

const SIZE: Size = Size::new(48, 40);
const WORDS: usize = 48 * 40;

/// A draw on a gradient, perhaps in fog: words, and depths.
fn drawn<F: BlendFormat>(
    draw: &Draw,
    surface: Surface<'static, F, Depth16>,
    fog: bool,
) -> (Vec<F::Word>, Vec<u16>) {
    let (mut pixels, mut depth) = (vec![F::rgb565(0); WORDS], vec![0; WORDS]);
    let mut band = Band::<F, Depth16>::new(SIZE, &mut pixels, &mut depth).expect("a band");
    let sky = Gradient::new(Rgb888::CSS_MIDNIGHT_BLUE, Rgb888::CSS_LIGHT_PINK, SIZE.height);
    band.clear_to(&sky);
    let (camera, mesh) = (draw.camera(SIZE), &meshes()[draw.mesh]);
    let view = camera.lit_by(&LIGHTS);
    if fog {
        let haze = Fog::linear(Rgb565::CSS_LIGHT_GRAY, I16F16::lit("1"), I16F16::lit("6"));
        view.in_fog(&haze).draw(mesh, &draw.pose, surface, &mut band);
    } else {
        view.draw(mesh, &draw.pose, surface, &mut band);
    }
    (pixels, depth)
}

/// Draws in a format and in one of 8 bits a channel that takes the same paths.
fn agrees<F: Shown, W: BlendFormat<Color = Rgb888>>(
    draws: &[(Draw, u16, bool)],
) -> Result<(), TestCaseError> {
    let (surfaces, wide) = (all::<F>(), all::<W>());
    prop_assert_eq!((F::COLOR_STEP, F::KEEPS), (W::COLOR_STEP, W::KEEPS));
    let is_gray = F::MOST.len() == 1;
    for (draw, number, fog) in draws {
        let number = usize::from(*number) % surfaces.len();
        let Rounded { name, surface, times, is_of_channels } = &surfaces[number];
        // Of a convex mesh without its backs each pixel is drawn once.
        if is_gray && *is_of_channels || *times > 1.0 && draw.mesh < 2 {
            continue;
        }
        let (words, depth) = drawn::<F>(draw, *surface, *fog);
        let (expected, expected_depth) = drawn::<W>(draw, wide[number].surface, *fog);
        prop_assert_eq!(depth, expected_depth, "{}", name);
        let times = times + if *fog { 1.0 } else { 0.0 };
        for (i, (word, wide)) in words.into_iter().zip(expected).enumerate() {
            let wide = W::decode(wide);
            let exact = F::exact([wide.r(), wide.g(), wide.b()].map(|channel| f64::from(channel) / 255.0));
            for ((level, exact), most) in F::levels(word).into_iter().zip(exact).zip(F::MOST) {
                // The 8 bits are rounded as often. Between vertices they are cut, which is up to half a level more.
                let is_between = ["Gouraud", "flat in light"].iter().any(|kind| name.starts_with(kind));
                let cut = if is_between { 0.5 * most / 255.0 } else { 0.0 };
                let bound = times / 2.0 * (1.0 + most / 255.0) + cut + 0.01;
                prop_assert!(
                    (level - exact).abs() <= bound,
                    "{}, fog {}: pixel {} is {}, not {}",
                    name,
                    fog,
                    i,
                    level,
                    exact
                );
            }
        }
    }
    Ok(())
}

#[test]
fn every_surface_is_in_every_format_what_it_is_in_8_bits_a_channel() {
    let draws = || prop::collection::vec((draw(), any::<u16>(), any::<bool>()), 12);
    for_all("surfaces in Bgr565", 300, draws(), |draws| agrees::<Bgr565, Wide<true>>(&draws));
    for_all("surfaces in Rgb666", 300, draws(), |draws| agrees::<Rgb666, Wide<false>>(&draws));
    for_all("surfaces in Gray8", 300, draws(), |draws| agrees::<Gray8, Rgb888>(&draws));
}

#[test]
fn backgrounds_are_the_nearest_colors_of_every_format() {
    fn check<F: Shown>() {
        let mut row = [F::rgb565(0); 37];
        for level in 0..=255_u8 {
            let color = Rgb888::new(level, !level, level / 2);
            Background::<F>::fill_row(&color, 3, &mut row);
            let rgb = [level, !level, level / 2].map(|channel| f64::from(channel) / 255.0);
            assert!(row.iter().all(|word| off::<F>(*word, rgb) <= 0.5001));
            Background::<F>::fill_row(&Gray8::new(level), 3, &mut row);
            assert!(row.iter().all(|word| off::<F>(*word, [f64::from(level) / 255.0; 3]) <= 0.5001));
        }
    }
    check::<Rgb565>();
    check::<Bgr565>();
    check::<Rgb666>();
    check::<Rgb888>();
    check::<Bgr888>();
    check::<Gray8>();
}
