//! The icon: a line from a hull to the seabed. `assets/draw.py` draws the picture in pixels.

/// The icon as a vector drawing.
pub(super) const SVG: &str = include_str!("assets/icon.svg");
/// The icon in pixels, which the standard requires in addition to a vector drawing.
pub(super) const PNG: &[u8] = include_bytes!("assets/icon.png");
