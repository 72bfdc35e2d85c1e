//! Pairs that a world doesn't report, such as bodies that a joint connects or links of one machine.

use super::{BodyId, World, WorldError};

impl World {
    /// Excludes a pair of bodies: it is not reported from the next cull on, until [`Self::include`]
    /// or until one of the bodies is removed. Returns whether the pair was included before; a body
    /// and itself are no pair.
    ///
    /// It costs one look-up per pair that passes the first test, and memory in proportion to the
    /// excluded pairs. Groups filter as before.
    ///
    /// ```
    /// # use sdop::{Body, ProceduralShape, Shape, ShapeSpec, World};
    /// # let cube = ProceduralShape::Box { x: 1.0, y: 1.0, z: 1.0 }.build()?;
    /// # let mut world = World::new(vec![Shape::build(&cube, &ShapeSpec::default())?])?;
    /// let [upper, lower] = [world.insert(Body::default())?, world.insert(Body::default())?];
    /// world.exclude(upper, lower)?; // a joint connects them
    /// assert_eq!(world.cull()?.len(), 0);
    /// world.include(upper, lower)?; // it broke
    /// assert_eq!(world.cull()?.len(), 1);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// A body that has been removed.
    pub fn exclude(&mut self, a: BodyId, b: BodyId) -> Result<bool, WorldError> {
        let [a, b] = [self.ids.slot(a)?, self.ids.slot(b)?];
        let is_new = a != b && self.culler.excluded_mut().insert(a as u32, b as u32);
        if is_new {
            self.movers.note(a, &self.ids); // its partners are found anew, and so the pair is lost
        }
        Ok(is_new)
    }

    /// Includes an excluded pair again. Returns whether it was excluded.
    ///
    /// # Errors
    /// A body that has been removed.
    pub fn include(&mut self, a: BodyId, b: BodyId) -> Result<bool, WorldError> {
        let [a, b] = [self.ids.slot(a)?, self.ids.slot(b)?];
        let was_excluded = self.culler.excluded_mut().remove(a as u32, b as u32);
        if was_excluded {
            self.movers.note(a, &self.ids);
        }
        Ok(was_excluded)
    }

    /// Whether a pair is excluded. A pair with a removed body is not.
    #[must_use]
    pub fn is_excluded(&self, a: BodyId, b: BodyId) -> bool {
        let slots = [a, b].map(|id| self.ids.slot(id));
        match slots {
            [Ok(a), Ok(b)] => self.culler.excluded().contains(a as u32, b as u32),
            _ => false,
        }
    }

    /// The excluded pairs, the lower slot first, sorted by slots.
    #[must_use]
    pub fn excluded(&self) -> Vec<[BodyId; 2]> {
        let pairs = self.culler.excluded().sorted();
        let ids = pairs.into_iter().map(|pair| pair.map(|slot| self.ids.id(slot)));
        ids.collect()
    }
}
