//! Surfaces: materials and shaders, their types forgotten.
//!
//! - In: a material, of which the recipe is kept by value; or a shader of the user, by reference.
//! - Out: what geometry and set-up have to know of it, and a painter for the triangles that are set up.
//! - Assumes: nothing.
//!
//! Code before the pixels is compiled once, whatever the surface. What differs by its type is one function: it chooses the loops
//! that fill pixels, and is called once a triangle.

use super::blend::{Code, LayerIn, Opaque};
use super::cover::{Cover, InFog, LayerCode, Layers};
use super::fog::{Fog, Fogging};
use super::kinds::{Kind, Opacity};
use super::material::Material;
use super::quality::Quality;
use super::recipe::Recipe;
use super::shader::{Reach, Shader};
use super::traits::Traits;
use super::{fragment, opaque};
use crate::frame::{BlendFormat, DepthFormat, PixelFormat};
use crate::geometry::{Coloring, Cull};
use crate::raster::Needs;
use crate::scene::Camera;
use core::fmt;

/// What a mesh is drawn with: a [`Material`], or a [`Shader`] of yours.
///
/// A material turns into one by itself where it is drawn with (`&material`), and is copied. A shader is kept
/// [by reference](Surface::new). A surface is a value, and forgets its type: an array can hold surfaces of different kinds.
///
/// ```
/// use fixel::embedded_graphics::{pixelcolor::Rgb565, prelude::*};
/// use fixel::{Depth16, Material, Surface};
/// let surfaces: [Surface<Rgb565, Depth16>; 2] =
///     [Material::flat(Rgb565::CSS_GOLD).surface(), Material::gouraud().exact().surface()];
/// # let _ = surfaces;
/// ```
pub struct Surface<'a, F: PixelFormat, D: DepthFormat> {
    pub(crate) cull: Cull,
    pub(crate) coloring: Coloring,
    pub(crate) look: Look<'a, F, D>,
}

/// What of a surface is needed after its vertices were coloured.
pub(crate) struct Look<'a, F: PixelFormat, D: DepthFormat> {
    pub(crate) traits: Traits,
    pub(crate) layers: Layers<F, D>,
    painter: Painter<'a, F, D>,
}

enum Painter<'a, F: PixelFormat, D: DepthFormat> {
    Material(Recipe<'a>, fn(&Recipe<'_>, Cover<'_, '_, F, D>)),
    Shader(&'a (dyn Paint<F, D> + Sync)),
}

/// A shader whose type is forgotten.
trait Paint<F: PixelFormat, D: DepthFormat> {
    fn paint_cover(&self, cover: Cover<'_, '_, F, D>);
}

impl<F: PixelFormat, D: DepthFormat, S: Shader<F>> Paint<F, D> for S {
    fn paint_cover(&self, cover: Cover<'_, '_, F, D>) {
        if S::REACH == Reach::Attributes {
            self.paint(cover);
        } else {
            fragment::draw(self, cover);
        }
    }
}

fn paint_material<F: PixelFormat, D: DepthFormat, K: Kind, Q: Quality>(
    recipe: &Recipe<'_>,
    cover: Cover<'_, '_, F, D>,
) {
    K::paint::<F, Q, _>(recipe, cover);
}

impl<'a, F: PixelFormat, D: DepthFormat> Surface<'a, F, D> {
    /// That of a shader, which stays borrowed. It may be shared with the other core of a chip (`Sync`).
    #[must_use]
    pub fn new<S: Shader<F> + Sync>(shader: &'a S) -> Self {
        let reads_target = S::REACH == Reach::Target;
        let code = if reads_target { &LayerCode::READS_TARGET } else { &LayerCode::OPAQUE };
        let layers = Layers { code, ..Layers::OPAQUE };
        let traits = Traits::of(shader).with_near_w(S::REACH != Reach::Attributes);
        Self {
            cull: shader.cull(),
            coloring: shader.coloring(),
            look: Look { traits, layers, painter: Painter::Shader(shader) },
        }
    }
}

impl<'a, F: BlendFormat, D: DepthFormat> InFog<'a, F, D> {
    /// Fog before a camera.
    pub(crate) fn new(fog: &Fog<'a>, camera: &Camera) -> Self {
        Self { fogging: Fogging::new(*fog, camera), draw_opaque: opaque::draw_in_fog }
    }
}

impl<'a, F, D, K, Q, L> From<&Material<'a, K, Q, L>> for Surface<'a, F, D>
where
    F: PixelFormat,
    D: DepthFormat,
    K: Kind,
    Q: Quality,
    L: LayerIn<F>,
{
    fn from(material: &Material<'a, K, Q, L>) -> Self {
        let Code(code) = L::code();
        let opacity = K::opacity::<Q>().map(|Opacity(write)| write);
        let layers = Layers { code, opacity, layering: material.layering };
        let traits = Traits::of::<F, _>(&material.cast::<K, Q, Opaque>());
        let traits = if opacity.is_some() { traits.with_gray() } else { traits };
        Self {
            cull: material.cull,
            coloring: material.coloring,
            look: Look {
                traits,
                layers,
                painter: Painter::Material(material.recipe, paint_material::<F, D, K, Q>),
            },
        }
    }
}

impl<'a, K: Kind, Q: Quality, L> Material<'a, K, Q, L> {
    /// The surface of this material: what `&material` turns into where it is drawn with.
    #[must_use]
    pub fn surface<F: PixelFormat, D: DepthFormat>(self) -> Surface<'a, F, D>
    where
        L: LayerIn<F>,
    {
        Surface::from(&self)
    }
}

impl<'a, F: PixelFormat, D: DepthFormat> From<&Self> for Surface<'a, F, D> {
    fn from(surface: &Surface<'a, F, D>) -> Self {
        *surface
    }
}

impl<F: PixelFormat, D: DepthFormat> Look<'_, F, D> {
    /// Whether pixels of both come out the same.
    pub(crate) fn is_like(&self, other: &Self) -> bool {
        self.traits == other.traits
            && self.layers.is_like(&other.layers)
            && match (&self.painter, &other.painter) {
                (Painter::Material(recipe, paint), Painter::Material(other, other_paint)) => {
                    recipe == other && core::ptr::fn_addr_eq(*paint, *other_paint)
                }
                (Painter::Shader(shader), Painter::Shader(other)) => core::ptr::eq(*shader, *other),
                _ => false,
            }
    }

    /// What set-up has to do, before a camera that may be orthographic, with colours that may all be grey, in fog or not.
    pub(crate) fn needs(&self, [is_orthographic, is_gray]: [bool; 2], is_foggy: bool) -> Needs {
        let depth = !D::ALWAYS_PASSES || is_foggy || self.traits.needs_near_w();
        self.traits.needs::<F>(depth, is_orthographic, is_gray)
    }

    /// Draws a triangle that is set up.
    #[inline]
    pub(crate) fn paint(&self, cover: Cover<'_, '_, F, D>) {
        match &self.painter {
            Painter::Material(recipe, paint) => paint(recipe, cover),
            Painter::Shader(shader) => shader.paint_cover(cover),
        }
    }
}

macro_rules! by_value {
    ($($type:ident),*) => {$(
        impl<F: PixelFormat, D: DepthFormat> Clone for $type<'_, F, D> {
            fn clone(&self) -> Self {
                *self
            }
        }

        impl<F: PixelFormat, D: DepthFormat> Copy for $type<'_, F, D> {}
    )*};
}

by_value!(Surface, Look, Painter);

impl<F: PixelFormat, D: DepthFormat> fmt::Debug for Surface<'_, F, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Surface")
            .field("inputs", &self.look.traits.inputs())
            .field("cull", &self.cull)
            .finish_non_exhaustive()
    }
}
