//! What can be asked for.

/// What is asked for; see the methods of [`Bake`](crate::Bake), which set it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Options {
    pub(crate) center: bool,
    pub(crate) unit: Option<f64>,
    /// The longest side in world units.
    pub(crate) size: Option<f64>,
    pub(crate) crease: f64,
    pub(crate) longest: u32,
    pub(crate) unlit: bool,
    pub(crate) objects: bool,
    pub(crate) thorough: bool,
    pub(crate) strict: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            center: false,
            unit: None,
            size: None,
            crease: 40.0,
            longest: 128,
            unlit: false,
            objects: false,
            thorough: false,
            strict: false,
        }
    }
}
