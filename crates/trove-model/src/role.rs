//! Roles of materials, by which a scene does something with their surfaces, and labels tell parts of objects.

/// What the surfaces of a material do in a scene besides looking as they look.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
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
    /// Who rides a bicycle, with clothes, helmet and bag.
    Cyclist,
    /// Who rides a motorcycle, likewise.
    Motorcyclist,
    /// A cycle that somebody rides.
    Ridden,
    /// The board of a shop, with its name.
    ShopSign,
    /// Cloth that shades a shop's window.
    Awning,
    /// A kerb's stones.
    Kerb,
    /// Trodden earth that people walk on.
    Unpaved,
    /// Ground beside the street with slabs or concrete on it: squares, yards.
    Paved,
    /// Ground where vehicles are parked.
    CarPark,
}

impl Role {
    /// Every role with its name in files. Its place, counted from 1, is its number in pictures of labels: new ones come
    /// last.
    pub const ALL: [(Self, &str); 20] = [
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
        (Self::Cyclist, "cyclist"),
        (Self::Motorcyclist, "motorcyclist"),
        (Self::Ridden, "ridden"),
        (Self::ShopSign, "shop_sign"),
        (Self::Awning, "awning"),
        (Self::Kerb, "kerb"),
        (Self::Unpaved, "unpaved"),
        (Self::Paved, "paved"),
        (Self::CarPark, "car_park"),
    ];

    /// Its number in pictures of labels, where 0 is no role.
    pub fn id(self) -> u8 {
        self as u8 + 1
    }

    /// Its name in files.
    pub fn name(self) -> &'static str {
        Self::ALL[self as usize].1
    }

    /// The role with a number.
    pub fn from_id(id: u8) -> Option<Self> {
        Self::ALL.get(usize::from(id).checked_sub(1)?).map(|(role, _)| *role)
    }

    /// The role with a name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|(_, known)| *known == name).map(|(role, _)| role)
    }
}
