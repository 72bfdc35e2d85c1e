//! Claims: which pairs a culler says that it never misses.

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
        /// As `aabb`, without the pairs that the frame's filter excludes, which must not be
        /// reported.
        Filter = "filter",
        /// As `aabb`, and the same pairs in whatever order the bodies come.
        Order = "order",
        /// As `aabb`, and the same pairs again after going back to a saved state.
        Restore = "restore",
        /// The boxes given with the frame are no further apart on any axis than both margins reach.
        Margin = "margin",
        /// As `mesh`, for bodies of several posed shapes: of any part of one and any of the other.
        Parts = "parts",
        /// As `aabb`, in space that repeats along the axes that have a period: some image of one
        /// box shares a point with the other.
        Periodic = "periodic",
    }
}

impl Claim {
    /// The claims about a single volume, without additional input.
    pub const PLAIN: &'static [Self] =
        &[Self::Sphere, Self::Aabb, Self::OrDop, Self::Hull, Self::Mesh];
    /// The claims about posed shapes: all but those about given boxes.
    pub const POSED: &'static [Self] =
        &[Self::Sphere, Self::OrDop, Self::Hull, Self::Mesh, Self::Parts];

    /// The claim that it is the same as without its own input: it gets all cases of that one, too.
    #[must_use]
    pub fn base(self) -> Option<Self> {
        match self {
            Self::Filter | Self::Order | Self::Restore | Self::Margin | Self::Periodic => {
                Some(Self::Aabb)
            }
            Self::Parts => Some(Self::Mesh),
            Self::Sphere | Self::Aabb | Self::OrDop | Self::Hull | Self::Mesh => None,
        }
    }

    /// Whether it is about given boxes.
    #[must_use]
    pub fn is_of_boxes(self) -> bool {
        !Self::POSED.contains(&self)
    }
}
