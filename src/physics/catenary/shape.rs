//! A solved line as a chain of pieces, and the quantities read from it: a point, the sag, lengths.

use super::flight::Flight;
use super::{Point, Section};

/// Support of a piece.
#[derive(Debug, Clone, Copy)]
pub(super) enum Kind {
    /// Support at both ends only.
    Flight(Flight),
    /// Straight on the seabed, with a tension that grows from `tension` [N] at its start by `growth` per metre [N/m].
    Laid {
        tension: f64,
        growth: f64,
        weight: f64,
        axial_stiffness: f64,
    },
    /// No support and no tension. The shape is not unique; it is taken as straight, advancing (x, z) per metre [-].
    Slack {
        x: f64,
        z: f64,
        weight: f64,
        on_seabed: bool,
    },
}

/// Piece of the line with its support and start.
#[derive(Debug, Clone, Copy)]
pub(super) struct Piece {
    /// Unstretched arc length at the start, from end A [m].
    pub s: f64,
    /// Unstretched length [m].
    pub length: f64,
    /// x of the start, relative to end A [m].
    pub x: f64,
    /// z of the start, relative to end A [m].
    pub z: f64,
    pub kind: Kind,
}

impl Piece {
    fn advance(&self, length: f64) -> (f64, f64) {
        match self.kind {
            Kind::Flight(flight) => flight.first(length).advance(),
            Kind::Laid {
                tension,
                growth,
                axial_stiffness,
                ..
            } => (
                length * (1.0 + (tension + 0.5 * growth * length) / axial_stiffness),
                0.0,
            ),
            Kind::Slack { x, z, .. } => (x * length, z * length),
        }
    }

    pub(super) fn on_seabed(&self) -> bool {
        matches!(self.kind, Kind::Laid { .. } | Kind::Slack { on_seabed: true, .. })
    }

    /// Stretched less unstretched length [m].
    pub(super) fn elongation(&self) -> f64 {
        match self.kind {
            Kind::Flight(flight) => flight.elongation(),
            Kind::Laid { .. } => self.advance(self.length).0 - self.length,
            Kind::Slack { .. } => 0.0,
        }
    }

    /// Support of the reversed piece.
    fn kind_reversed(&self) -> Kind {
        match self.kind {
            Kind::Flight(flight) => Kind::Flight(Flight {
                vertical: -flight.vertical_end(),
                ..flight
            }),
            Kind::Laid {
                tension,
                growth,
                weight,
                axial_stiffness,
            } => Kind::Laid {
                tension: tension + growth * self.length,
                growth: -growth,
                weight,
                axial_stiffness,
            },
            Kind::Slack {
                x,
                z,
                weight,
                on_seabed,
            } => Kind::Slack {
                x,
                z: -z,
                weight,
                on_seabed,
            },
        }
    }

    fn point(&self, length: f64) -> Point {
        let (dx, dz) = self.advance(length);
        let (horizontal, vertical) = match self.kind {
            Kind::Flight(flight) => (flight.horizontal, flight.first(length).vertical_end()),
            Kind::Laid { tension, growth, .. } => (tension + growth * length, 0.0),
            Kind::Slack { .. } => (0.0, 0.0),
        };
        Point {
            x: self.x + dx,
            z: self.z + dz,
            horizontal,
            vertical,
            tension: horizontal.hypot(vertical),
        }
    }
}

/// Pieces of a line from A to B, each starting at the end of the previous one.
#[derive(Debug, Clone, Default)]
pub(super) struct Shape {
    pub pieces: Vec<Piece>,
    /// End of the last piece: s, x, z [m].
    pub end: (f64, f64, f64),
}

impl Shape {
    /// Removes the pieces and keeps their allocation.
    pub(super) fn clear(&mut self) {
        self.pieces.clear();
        self.end = (0.0, 0.0, 0.0);
    }

    /// Appends `length` metres carried by `kind`, if the length is positive.
    pub(super) fn push(&mut self, length: f64, kind: Kind) {
        if length <= 0.0 {
            return;
        }
        let (s, x, z) = self.end;
        let piece = Piece {
            s,
            length,
            x,
            z,
            kind,
        };
        let (dx, dz) = piece.advance(length);
        self.end = (s + length, x + dx, z + dz);
        self.pieces.push(piece);
    }

    /// Appends a flight over `length` metres of `section` that starts under H and V.
    pub(super) fn fly(&mut self, section: &Section, length: f64, horizontal: f64, vertical: f64) {
        self.push(
            length,
            Kind::Flight(Flight::of(section, length, horizontal, vertical)),
        );
    }

    /// Appends `length` metres of `section` on the seabed.
    pub(super) fn lay(&mut self, section: &Section, length: f64, tension: f64, growth: f64) {
        if tension == 0.0 && growth == 0.0 {
            self.push(
                length,
                Kind::Slack {
                    x: 1.0,
                    z: 0.0,
                    weight: section.weight,
                    on_seabed: true,
                },
            );
        } else {
            self.push(
                length,
                Kind::Laid {
                    tension,
                    growth,
                    weight: section.weight,
                    axial_stiffness: section.axial_stiffness,
                },
            );
        }
    }

    /// Returns the same line from B to A.
    pub(super) fn reversed(&self) -> Shape {
        let mut reversed = Shape::default();
        for piece in self.pieces.iter().rev() {
            reversed.push(piece.length, piece.kind_reversed());
        }
        reversed
    }

    /// Replaces pieces whose tension nowhere exceeds `nothing` [N] by slack ones, and sets horizontal tensions up to `nothing` to zero.
    pub(super) fn relax(&mut self, nothing: f64) {
        for piece in &mut self.pieces {
            let (x, z) = piece.advance(piece.length);
            let (x, z) = (x / piece.length, z / piece.length);
            match &mut piece.kind {
                Kind::Flight(flight) if flight.horizontal <= nothing => {
                    flight.horizontal = 0.0;
                    if flight.vertical.abs() <= nothing && flight.vertical_end().abs() <= nothing {
                        piece.kind = Kind::Slack {
                            x,
                            z,
                            weight: flight.weight,
                            on_seabed: false,
                        };
                    }
                }
                Kind::Laid {
                    tension,
                    growth,
                    weight,
                    ..
                } if *tension <= nothing => {
                    *tension = 0.0;
                    if *growth == 0.0 {
                        piece.kind = Kind::Slack {
                            x,
                            z,
                            weight: *weight,
                            on_seabed: true,
                        };
                    }
                }
                _ => {}
            }
        }
    }

    /// Shortens the horizontal advance of the slack pieces so that the line ends at `x` [m].
    pub(super) fn close(&mut self, x: f64) {
        let advance = |piece: &Piece| match piece.kind {
            Kind::Slack { x, .. } => x * piece.length,
            _ => 0.0,
        };
        let slack: f64 = self.pieces.iter().map(advance).sum();
        if slack <= 0.0 {
            return;
        }
        let factor = ((x - self.end.1 + slack) / slack).clamp(0.0, 1.0);
        let pieces = std::mem::take(&mut self.pieces);
        self.end = (0.0, 0.0, 0.0);
        for piece in pieces {
            let kind = match piece.kind {
                Kind::Slack {
                    x,
                    z,
                    weight,
                    on_seabed,
                } => Kind::Slack {
                    x: x * factor,
                    z,
                    weight,
                    on_seabed,
                },
                kind => kind,
            };
            self.push(piece.length, kind);
        }
    }

    /// Material point at `s` metres of unstretched length from A; beyond an end, that end.
    pub(super) fn at(&self, s: f64) -> Point {
        let next = self.pieces.partition_point(|piece| piece.s <= s);
        let piece = &self.pieces[next.saturating_sub(1)];
        piece.point((s - piece.s).clamp(0.0, piece.length))
    }

    /// Maximum vertical distance below the chord from (0, 0) to (`span`, `rise`) [m]; below the lower end where the span is 0.
    pub(super) fn sag(&self, span: f64, rise: f64) -> f64 {
        let below = |point: Point| {
            let chord = if span > 0.0 {
                rise * (point.x / span)
            } else {
                rise.min(0.0)
            };
            chord - point.z
        };
        let mut sag = 0.0_f64;
        for piece in &self.pieces {
            sag = sag.max(below(piece.point(0.0)));
            if let Kind::Flight(flight) = piece.kind {
                // lowest where the tension is parallel to the chord
                let vertical = if span > 0.0 {
                    flight.horizontal * (rise / span)
                } else {
                    0.0
                };
                if let Some(length) = flight.where_vertical_is(vertical) {
                    sag = sag.max(below(piece.point(length)));
                }
            }
        }
        sag
    }
}
