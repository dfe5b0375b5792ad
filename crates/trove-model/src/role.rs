//! Roles of materials, by which a scene does something with their surfaces.

/// What the surfaces of a material do in a scene besides looking as they look.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Role {
    /// The lens of a street lamp: it shines in the dark.
    StreetLamp,
    /// A lamp on a wall: it shines in the dark.
    WallLamp,
    /// The shade of a lamp in a room where people are in: it shines in the dark.
    RoomLamp,
    /// A bright panel below a ceiling, in an office: it shines in the dark.
    LightPanel,
    /// The same in a shop: it shines in the dark while shops are open.
    ShopPanel,
    /// A lamp over a shop's sign: it shines in the dark until late.
    SignLamp,
    /// A headlamp of a vehicle: it shines in the dark, and in fog, rain and snow, while the vehicle is driven.
    Headlamp,
    /// A tail lamp of a vehicle, likewise.
    TailLamp,
    /// What wires hang on.
    Insulator,
    /// The plate of a street name that lies along the sign's x axis: a name is written on it.
    NameAlongX,
    /// The plate that lies along the y axis, likewise.
    NameAlongY,
}

impl Role {
    /// Every role with its name in files.
    pub const ALL: [(Self, &str); 11] = [
        (Self::StreetLamp, "street_lamp"),
        (Self::WallLamp, "wall_lamp"),
        (Self::RoomLamp, "room_lamp"),
        (Self::LightPanel, "light_panel"),
        (Self::ShopPanel, "shop_panel"),
        (Self::SignLamp, "sign_lamp"),
        (Self::Headlamp, "headlamp"),
        (Self::TailLamp, "tail_lamp"),
        (Self::Insulator, "insulator"),
        (Self::NameAlongX, "name_along_x"),
        (Self::NameAlongY, "name_along_y"),
    ];

    /// The role with a name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|(_, known)| *known == name).map(|(role, _)| role)
    }
}
