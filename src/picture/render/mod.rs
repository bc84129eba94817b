//! stub
pub struct Scene;
pub struct Camera;
pub struct Overlay;
pub fn draw() {}
