# What a shopper reads, in French.

language = Français

# No person is in view
attract-heading = Voyez comment ça tombe avant d’essayer
attract-measure = Placez-vous sur le repère. Le miroir prend vos mesures en une seconde.
attract-fit = Voyez-vous dans votre taille, et là où ça serre.
attract-compare = Mettez deux tailles côte à côte.
attract-private = Rien n’est conservé, rien n’est envoyé. Quand vous partez, tout est oublié.

# A person has stepped in
guide-heading = Placez-vous sur le repère
guide-heading-seated = Tournez-vous vers le miroir
guide-pose = Pieds écartés, bras un peu éloignés du corps.
guide-pose-seated = Gardez le dos droit, bras un peu éloignés du corps.
guide-nearer = Approchez-vous un peu.
guide-farther = Reculez un peu.
guide-left = Décalez-vous un peu vers votre gauche.
guide-right = Décalez-vous un peu vers votre droite.
guide-alone = Une personne à la fois, s’il vous plaît.
guide-unseen = Le miroir ne vous voit pas encore. Placez-vous sur le repère.
camera-lost = La caméra ne répond pas en ce moment. Veuillez patienter un instant.
camera-covered = Quelque chose cache la caméra. Veuillez la dégager.
guide-soon = La mesure commence dans un instant.

# Measuring
measuring-heading = Un instant, s’il vous plaît
measuring-body = Prise de mesures
measuring-dress = Habillage en cours
turn-offer = Si vous le souhaitez, faites lentement un tour sur vous-même. Vos mesures seront plus sûres.
turn-on = Continuez à tourner, lentement.
turn-enough = Merci, le tour est complet.

# What could not be measured
unmeasured-heading = Cela n’a pas fonctionné
unmeasured-why = Le miroir doit vous voir de la tête aux genoux, sans personne d’autre, pendant une seconde. Les manteaux amples et les sacs cachent le corps.
unmeasured-seated = Vous êtes en position assise ? Choisissez « Je suis en position assise ».
partly-heading = Mesures prises autant que possible
partly-missing = Non visible : { $parts }.
partly-guess = À la place figure un corps moyen de votre stature ; ces zones sont moins sûres.
partly-cure = Un mètre ruban à la taille et aux hanches lève le doute.

# The fitted body
fitting-size = { $garment }, taille { $size }
fitting-best = La taille { $size } vous va le mieux.
fitting-nearest = La taille { $size } est la plus proche, mais ne va pas partout.
fitting-one-size = Il existe en une seule taille.
fitting-size-unknown = Montré tel qu’il est fait : sa taille n’est pas connue.
fitting-sure = Sûr à { $percent } %.
fitting-unsure = On hésite : { $percent } %.
fitting-better = La taille { $size } vous irait mieux.
fitting-tape = Un mètre ruban lève le doute : { $zone }.
fitting-smaller = Même la plus petite taille est prévue pour des mesures plus grandes. Voici la plus proche.
fitting-larger = Même la plus grande taille est prévue pour des mesures plus petites. Voici la plus proche.
fitting-dressing = Habillage en cours
fitting-refused = Impossible d’enfiler ce vêtement. Vous voyez ce que vous portiez avant.
own-picture-kept = Vous seul voyez ceci. Votre image n’est ni gardée ni envoyée.
own-picture-soon = Votre image arrive dans un instant.
own-picture-cannot = Les vêtements ne peuvent pas être posés sur l’image de cette caméra. Choisissez le mannequin.
own-picture-nobody = Le miroir ne vous voit pas. Placez-vous sur la marque.
own-picture-back = Reculez un peu, pour que les vêtements entrent dans l’image.
own-picture-still = Restez un instant immobile, face au miroir.

# The shopper’s own face on the mannequin
face-heading = Votre visage sur le mannequin
face-what = Quand vous appuyez, une image de vous est prise, et le mannequin reçoit votre visage. Tenez-vous droit et regardez le miroir.
face-kept = L’image et le visage restent dans la seule mémoire de ce miroir. Ils ne sont envoyés nulle part et sont effacés dès que vous retirez le visage ou partez.
face-taking = Votre visage est mis en place
face-on = Le mannequin a votre visage.
face-no-picture = La caméra n’a pas donné d’image. Veuillez réessayer dans un instant.
face-unseen = Aucun visage n’a été vu. Placez-vous devant le miroir, regardez-le et réessayez.
face-far = Votre visage est trop loin. Approchez-vous et réessayez.
face-turned = Votre visage était tourné. Regardez le miroir bien en face et réessayez.
face-unlike = Votre visage n’a pas pu être mis. Écartez-en cheveux et mains et réessayez.

# The garments
garments-heading = Que souhaitez-vous essayer ?
garments-worn = Vous le portez
garments-take-off = Touchez encore pour l’enlever
garments-instead = Remplace : { $others }
garment-strap-dress = Robe d’été
garment-tee = T-shirt
garment-wide-leg-trousers = Pantalon large
garment-mens-blazer = Veste ouverte
garment-circle-skirt = Jupe cercle
garment-slim-trousers = Pantalon étroit
garment-shirt = Chemise vichy
garment-jumper = Pull rayé
garment-mens-shirt = Chemise homme
garment-mens-trousers = Pantalon homme
garment-blazer = Blazer
garment-coat = Manteau
colour-of = Couleur : { $colour }
colour-own = Telle que tissée
colour-coral = Corail
colour-ivory = Ivoire
colour-sky = Bleu ciel
colour-moss = Vert mousse
colour-navy = Bleu marine
colour-denim = Bleu jean
colour-white = Blanc
colour-ochre = Ocre
colour-brick = Rouge brique
colour-charcoal = Anthracite
colour-sand = Sable

# Fit by zone
zones-heading = Comment tombe la taille { $size }
zones-held =
    Le vêtement tient { $level ->
        [neck] au cou
        [shoulders] aux épaules
        [bust] à la poitrine
        [underbust] sous la poitrine
        [waist] à la taille
        [crotch] à l’entrejambe
       *[feet] aux pieds
    }.
zone-chest = Poitrine
zone-waist = Taille
zone-hip = Hanches
fit-ease = { $zone } : { $feel } (+{ $ease } ± { $sigma } cm)
fit-lack = { $zone } : { $feel } (-{ $ease } ± { $sigma } cm)
fit-perhaps = { $fit }, peut-être { $feel }
fit-unknown = { $zone } : pas visible, l’ajustement n’est donc pas connu
feel-unknown = non connu
feel-too-tight = beaucoup trop serré
feel-tight = serré
feel-snug = près du corps
feel-right = parfait
feel-roomy = confortable
feel-loose = large
feel-too-loose = beaucoup trop large
legend-loose = large
legend-tight = serré

# Why
zone-heading = { $zone } : pourquoi ?
zone-body = Votre tour de { $zone } mesure environ { $body } cm, à { $sigma } cm près.
zone-garment = Le vêtement y mesure { $garment } cm.
zone-comfort = Pour cette coupe, { $least } à { $most } cm d’aisance sont agréables.
zone-stretch = Pour cette coupe, de { $least } cm d’étirement à { $most } cm d’aisance sont agréables.
zone-primary = La taille est choisie d’après cette mesure.
zone-taped = Vous l’avez mesuré au mètre ruban.
zone-seen = La mesure a été prise à la surface de votre corps.
zone-bones = Seules votre stature et vos épaules étaient visibles. Le tour en est déduit et reste incertain.
zone-guessed = Cette zone n’était pas visible. Une moyenne pour votre stature la remplace.
zone-surer-tape = Un mètre ruban lève le doute.
zone-surer-again = Une nouvelle mesure sans manteau ni sac sera plus sûre.

# Two sizes
compare-heading = Taille { $left } ou { $right } ?
compare-zone = { $zone } : en { $left } { $left-feel }, en { $right } { $right-feel }
compare-same = { $zone } : { $feel } dans les deux tailles
compare-unknown = { $zone } : non connu pour les deux tailles
compare-draping = Habillage dans les deux tailles
compare-refused = Impossible d’enfiler les deux tailles. Les indications restent valables.

# Measures by tape
own-heading = Vos propres mesures
own-why = Ce que vous avez mesuré au mètre ruban compte plus que ce que voit le miroir. Choisissez une mesure.
own-forgotten = Quand vous partez, elles sont oubliées aussi.
own-given = Retenu : { $length }.
own-chest = Poitrine
own-waist = Taille
own-hip = Hanches
own-stature = Stature
own-underbust = Dessous de poitrine
own-leg = Entrejambe
own-arm = Bras
own-shoulders = Carrure
own-neck = Cou
own-thigh = Cuisse
own-torso = Du cou à l’entrejambe
length-cm = { $length } cm
length-inch = { $length } po
entry-heading = { $measure } : combien ?
entry-how = Entrez la longueur, puis validez.
entry-empty = Entrez d’abord une longueur.
entry-impossible = { $measure } : chez les gens, c’est de { $low } à { $high }. Vérifiez le nombre et l’unité.
entry-contradiction = { $measure } : { $given } ne va pas avec vos autres mesures. Selon elles, ce serait { $expected } ± { $sigma }. Mesurez de nouveau ou retirez-en une.

# The picture
picture-heading = Votre image
picture-taking = L’image est en cours
picture-scan = Scannez le code avec votre téléphone. Il contient l’image elle-même ; rien n’est envoyé.
picture-served = Scannez le code avec un téléphone connecté au réseau de ce magasin. L’image y est servie sans chiffrement ; elle ne quitte pas le magasin.
picture-served-in = Scannez le code avec un téléphone connecté au réseau { $network }. L’image y est servie sans chiffrement ; elle ne quitte pas le magasin.
picture-until =
    { $minutes ->
        [0] Elle sera effacée dans moins d’une minute.
        [one] Elle sera effacée dans { $minutes } minute.
       *[other] Elle sera effacée dans { $minutes } minutes.
    }
picture-failed = L’image n’a pas fonctionné. Veuillez réessayer.

# Settings
settings-heading = Langue et réglages
settings-stored = Le miroir ne conserve rien. Il ne connaît vos mesures que tant que vous êtes là, et les oublie quand vous partez.
settings-known =
    { $count ->
        [0] Il ne connaît aucune de vos mesures.
        [one] Il connaît actuellement { $count } de vos mesures.
       *[other] Il connaît actuellement { $count } de vos mesures.
    }

# Another person
second-heading = Est-ce toujours vous ?
second-why = Quelqu’un d’autre semble être là. Ce qui était affiché est masqué.
second-seconds =
    { $seconds ->
        [one] Dans { $seconds } seconde, tout sera oublié.
       *[other] Dans { $seconds } secondes, tout sera oublié.
    }

# No person is in view
leaving-heading = Êtes-vous encore là ?
leaving-seconds =
    { $seconds ->
        [one] Dans { $seconds } seconde, tout sera oublié.
       *[other] Dans { $seconds } secondes, tout sera oublié.
    }

# What can be pressed
do-begin = Commencer
do-measure = Prendre mes mesures
do-measure-again = Mesurer à nouveau
do-seated = Je suis en position assise
do-garments = Choisir des vêtements
do-garments-more = Autres vêtements
do-garments-before = Vêtements précédents
do-zones = Comment ça tombe ?
do-compare = Comparer deux tailles
do-smaller = Taille en dessous
do-larger = Taille au-dessus
do-size = Taille { $size }
do-turn-left = Tourner à gauche
do-turn-right = Tourner à droite
do-fit-map = Carte d’ajustement
do-own-picture = Me voir
do-mannequin = Voir le mannequin
do-face = Mon visage
do-face-put-on = Mettre mon visage
do-face-again = Réessayer
do-face-away = Retirer le visage
do-picture = Prendre une image
do-show-picture = Montrer l’image
do-delete-picture = Effacer maintenant
do-picture-link = Grande image
do-picture-own = Pas dans ce réseau
do-settings = Langue et réglages
do-large = Grands caractères
do-wear = Porter la taille { $size }
do-own-measures = Je connais mes mesures
do-delete = Effacer
do-inches = En pouces
do-centimetres = En centimètres
do-accept = Valider
do-remove = Retirer cette mesure
do-go-on = Continuer
do-back = Retour
do-stay = Je suis encore là
do-still-me = C’est toujours moi
do-begin-anew = Recommencer
do-leave = J’ai fini : oubliez-moi

# Parts of the body that are measured
part-stature = stature
part-shoulders = épaules
part-chest = poitrine
part-waist = taille
part-hip = hanches
part-legs = longueur de jambe
list-and = { $first } et { $last }
list-comma = { $first }, { $last }
