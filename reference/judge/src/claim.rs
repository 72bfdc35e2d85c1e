//! What a culler claims never to miss.

use sdop::choice::choices;

choices! {
    /// One predicate each, decided exactly: a pair of which it holds, at least one body dynamic,
    /// has to be reported.
    Claim, "claim", {
        /// The bounding balls, posed exactly, share a point.
        Sphere = "sphere",
        /// The boxes given with the frame share a point.
        Aabb = "aabb",
        /// The oriented k-DOPs share a point.
        OrDop = "or-dop",
        /// The convex hulls of the meshes share a point.
        Hull = "hull",
        /// The meshes share a point, or a part of one lies inside of a closed part of the other.
        Mesh = "mesh",
    }
}

impl Claim {
    /// The claims about posed shapes: all but the one about given boxes.
    pub const POSED: &'static [Self] = &[Self::Sphere, Self::OrDop, Self::Hull, Self::Mesh];
}
