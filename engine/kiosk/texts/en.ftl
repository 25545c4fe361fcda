# What a shopper reads, in English. Lengths come in centimetres, already rounded; every language has the same words with
# the same variables.

language = English

# No person is in view
attract-heading = See how it fits, before you try it on
attract-measure = Step onto the mark. The mirror measures you in a second.
attract-fit = See yourself in your size, and where it is snug.
attract-compare = Put two sizes side by side.
attract-private = Nothing is kept and nothing is sent. When you leave, you are forgotten.

# A person has stepped in
guide-heading = Stand on the mark
guide-heading-seated = Face the mirror
guide-pose = Feet apart, arms a little away from your body.
guide-pose-seated = Sit upright, arms a little away from your body.
guide-nearer = Come a little closer.
guide-farther = Step back a little.
guide-left = Move a little to your left.
guide-right = Move a little to your right.
guide-alone = One person at a time, please.
guide-unseen = The mirror does not see you yet. Step onto the mark.
camera-lost = The camera does not answer just now. Please wait a moment.
camera-covered = Something covers the camera. Please clear the view of it.
guide-soon = Measuring begins in a moment.

# Measuring
measuring-heading = One moment, please
measuring-body = Measuring
measuring-dress = Putting the clothes on
turn-offer = If you like, turn round once, slowly. Your measures become surer.
turn-on = Keep turning, slowly.
turn-enough = Thank you, that was all round.

# What could not be measured
unmeasured-heading = That did not work
unmeasured-why = The mirror needs to see you from head to knees, alone, for a second. Loose coats and bags hide the body.
unmeasured-seated = Are you sitting? Then choose “I am sitting”.
partly-heading = Measured as far as possible
partly-missing = Not seen: { $parts }.
partly-guess = There an average body of your height stands in, so these zones are less certain.
partly-cure = A tape measure at the waist and hip makes it certain.

# The fitted body
fitting-size = { $garment }, size { $size }
fitting-best = Size { $size } fits you best.
fitting-nearest = Size { $size } comes nearest, but does not fit everywhere.
fitting-one-size = It comes in one size.
fitting-size-unknown = It is shown as it was made: its size is not known.
fitting-sure = We are { $percent } % sure.
fitting-unsure = It is close: { $percent } %.
fitting-better = Size { $size } would fit you better.
fitting-tape = A tape makes it sure: { $zone }.
fitting-smaller = Even the smallest size is meant for larger measures. You see the nearest.
fitting-larger = Even the largest size is meant for smaller measures. You see the nearest.
fitting-dressing = Putting it on
fitting-refused = This could not be put on. You see what you wore before.
own-picture-kept = Only you see this. Your picture is neither kept nor sent.
own-picture-soon = Your picture comes in a moment.
own-picture-cannot = The clothes cannot be put on this camera’s picture. Choose the mannequin.
own-picture-nobody = The mirror does not see you. Step onto the mark.
own-picture-back = Step back a little, so that the clothes fit into the picture.
own-picture-still = Stand still for a moment, facing the mirror.

# The shopper’s own face on the mannequin
face-heading = Your face on the mannequin
face-what = When you press, one picture of you is taken, and the mannequin gets your face. Stand upright and look at the mirror.
face-kept = Picture and face are in this mirror’s memory alone. They are sent nowhere, and are wiped when you take the face away or leave.
face-taking = Your face is being put on
face-on = The mannequin has your face.
face-no-picture = The camera gave no picture. Please try again in a moment.
face-unseen = No face was seen. Stand before the mirror, look at it, and try again.
face-far = Your face is too far away. Step nearer and try again.
face-turned = Your face was turned away. Look straight at the mirror and try again.
face-unlike = Your face could not be put on. Take hair and hands from it and try again.

# The garments
garments-heading = What would you like to try on?
garments-worn = You are wearing it
garments-take-off = Tap again to take it off
garments-instead = Replaces: { $others }
garment-strap-dress = Sun dress
garment-tee = T-shirt
garment-wide-leg-trousers = Wide trousers
garment-mens-blazer = Open jacket
garment-circle-skirt = Circle skirt
garment-slim-trousers = Slim trousers
garment-shirt = Gingham shirt
garment-jumper = Striped jumper
garment-mens-shirt = Men’s shirt
garment-mens-trousers = Men’s trousers
garment-blazer = Blazer
garment-coat = Coat
colour-of = Colour: { $colour }
colour-own = As woven
colour-coral = Coral
colour-ivory = Ivory
colour-sky = Sky blue
colour-moss = Moss green
colour-navy = Navy
colour-denim = Denim blue
colour-white = White
colour-ochre = Ochre
colour-brick = Brick red
colour-charcoal = Charcoal
colour-sand = Sand

# Fit by zone
zones-heading = How size { $size } fits
zones-held =
    It hangs from the { $level ->
        [neck] neck
        [shoulders] shoulders
        [bust] bust
        [underbust] underbust
        [waist] waist
        [crotch] crotch
       *[feet] feet
    }.
zone-chest = Chest
zone-waist = Waist
zone-hip = Hip
fit-ease = { $zone }: { $feel } (+{ $ease } ± { $sigma } cm)
fit-lack = { $zone }: { $feel } (-{ $ease } ± { $sigma } cm)
fit-perhaps = { $fit }, perhaps { $feel }
fit-unknown = { $zone }: not seen, so how it fits is not known
feel-unknown = not known
feel-too-tight = far too tight
feel-tight = tight
feel-snug = snug
feel-right = just right
feel-roomy = roomy
feel-loose = loose
feel-too-loose = far too loose
legend-loose = loose
legend-tight = tight

# Why
zone-heading = { $zone }: why?
zone-body = Your { $zone } measures about { $body } cm, give or take { $sigma } cm.
zone-garment = The garment measures { $garment } cm there.
zone-comfort = { $least } to { $most } cm of ease feel right in this cut.
zone-stretch = From { $least } cm stretch to { $most } cm of ease feels right in this cut.
zone-primary = The size is chosen by this measure.
zone-taped = You measured it with a tape.
zone-seen = It was measured on your body's surface.
zone-bones = Only your height and shoulders were seen. The girth follows from them and is uncertain.
zone-guessed = It could not be seen. An average for your height stands in.
zone-surer-tape = A tape measure makes it certain.
zone-surer-again = Measuring again without a coat or bag makes it surer.

# Two sizes
compare-heading = Size { $left } or { $right }?
compare-zone = { $zone }: { $left } is { $left-feel }, { $right } is { $right-feel }
compare-same = { $zone }: both are { $feel }
compare-unknown = { $zone }: not known in either size
compare-draping = Putting on both sizes
compare-refused = Both sizes could not be put on. The words still hold.

# Measures by tape
own-heading = Your own measures
own-why = What you measured with a tape counts for more than what the mirror sees. Choose a measure.
own-forgotten = When you leave, they are forgotten too.
own-given = Accepted: { $length }.
own-chest = Chest
own-waist = Waist
own-hip = Hip
own-stature = Height
own-underbust = Under the bust
own-leg = Inside leg
own-arm = Arm
own-shoulders = Shoulders
own-neck = Neck
own-thigh = Thigh
own-torso = Neck to crotch
length-cm = { $length } cm
length-inch = { $length } in
entry-heading = { $measure }: how much?
entry-how = Type the length, then accept it.
entry-empty = Type a length first.
entry-impossible = { $measure }: people have { $low } to { $high }. Please check the number and the unit.
entry-contradiction = { $measure }: { $given } does not go with your other measures. They suggest { $expected } ± { $sigma }. Measure again, or remove one.

# The picture
picture-heading = Your picture
picture-taking = Taking the picture
picture-scan = Scan the code with your phone. It holds the picture itself; nothing is sent.
picture-served = Scan the code while your phone is in this shop’s network. The picture is offered there without encryption; it does not leave the shop.
picture-served-in = Scan the code while your phone is in the network { $network }. The picture is offered there without encryption; it does not leave the shop.
picture-until =
    { $minutes ->
        [0] It is deleted in less than a minute.
        [one] It is deleted in { $minutes } minute.
       *[other] It is deleted in { $minutes } minutes.
    }
picture-failed = The picture did not work. Please try again.

# Settings
settings-heading = Language and settings
settings-stored = The mirror keeps nothing. It knows your measures only while you stand here, and forgets them when you leave.
settings-known =
    { $count ->
        [0] It knows no measure of you.
        [one] It knows { $count } measure of you now.
       *[other] It knows { $count } measures of you now.
    }

# Another person
second-heading = Is it still you?
second-why = Somebody else seems to stand here. What was shown is hidden.
second-seconds =
    { $seconds ->
        [one] In { $seconds } second everything is forgotten.
       *[other] In { $seconds } seconds everything is forgotten.
    }

# No person is in view
leaving-heading = Are you still there?
leaving-seconds =
    { $seconds ->
        [one] In { $seconds } second you are forgotten.
       *[other] In { $seconds } seconds you are forgotten.
    }

# What can be pressed
do-begin = Begin
do-measure = Measure me
do-measure-again = Measure again
do-seated = I am sitting
do-garments = Choose clothes
do-garments-more = More clothes
do-garments-before = Clothes before
do-zones = How does it fit?
do-compare = Compare two sizes
do-smaller = Smaller size
do-larger = Larger size
do-size = Size { $size }
do-turn-left = Turn left
do-turn-right = Turn right
do-fit-map = Fit map
do-own-picture = See myself
do-mannequin = See the mannequin
do-face = My face
do-face-put-on = Put my face on
do-face-again = Try again
do-face-away = Take it away
do-picture = Take a picture
do-show-picture = Show the picture
do-delete-picture = Delete now
do-picture-link = Large picture
do-picture-own = Not in this network
do-settings = Language and settings
do-large = Large type
do-wear = Wear size { $size }
do-own-measures = I know my measures
do-delete = Delete
do-inches = Inches
do-centimetres = Centimetres
do-accept = Accept
do-remove = Remove this measure
do-go-on = Go on
do-back = Back
do-stay = I am still here
do-still-me = It is still me
do-begin-anew = Begin anew
do-leave = I am done: forget me

# Parts of the body that are measured
part-stature = height
part-shoulders = shoulders
part-chest = chest
part-waist = waist
part-hip = hip
part-legs = leg length
list-and = { $first } and { $last }
list-comma = { $first }, { $last }
