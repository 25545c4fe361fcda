# What a shopper reads, in Spanish.

language = Español

# No person is in view
attract-heading = Vea cómo le queda antes de probárselo
attract-measure = Colóquese sobre la marca. El espejo toma sus medidas en un segundo.
attract-fit = Véase en su talla y descubra dónde queda ceñido.
attract-compare = Ponga dos tallas una al lado de la otra.
attract-private = No se guarda ni se envía nada. Cuando se va, todo se olvida.

# A person has stepped in
guide-heading = Colóquese sobre la marca
guide-heading-seated = Mire hacia el espejo
guide-pose = Pies separados y brazos un poco apartados del cuerpo.
guide-pose-seated = Siéntese con la espalda recta y los brazos un poco apartados del cuerpo.
guide-nearer = Acérquese un poco.
guide-farther = Dé un paso atrás.
guide-left = Muévase un poco hacia su izquierda.
guide-right = Muévase un poco hacia su derecha.
guide-alone = De uno en uno, por favor.
guide-unseen = El espejo aún no le ve. Colóquese sobre la marca.
camera-lost = La cámara no responde en este momento. Espere un instante, por favor.
camera-covered = Algo tapa la cámara. Despéjela, por favor.
guide-soon = La medición empieza enseguida.

# Measuring
measuring-heading = Un momento, por favor
measuring-body = Tomando medidas
measuring-dress = Poniendo la ropa
turn-offer = Si quiere, dé una vuelta completa, despacio. Sus medidas serán más seguras.
turn-on = Siga girando, despacio.
turn-enough = Gracias, la vuelta está completa.

# What could not be measured
unmeasured-heading = No ha funcionado
unmeasured-why = El espejo necesita verle de la cabeza a las rodillas, sin nadie más, durante un segundo. Los abrigos amplios y los bolsos ocultan el cuerpo.
unmeasured-seated = ¿Está en posición sentada? Elija «En posición sentada».
partly-heading = Medido hasta donde es posible
partly-missing = No se ha visto: { $parts }.
partly-guess = Ahí se muestra un cuerpo medio de su estatura; esas zonas son menos seguras.
partly-cure = Una cinta métrica en cintura y cadera lo deja claro.

# The fitted body
fitting-size = { $garment }, talla { $size }
fitting-best = La talla { $size } es la que mejor le queda.
fitting-nearest = La talla { $size } es la más cercana, pero no queda bien en todas partes.
fitting-one-size = Hay una sola talla.
fitting-size-unknown = Se muestra tal como está hecho: no se conoce su talla.
fitting-sure = Seguro al { $percent } %.
fitting-unsure = Hay dudas: { $percent } %.
fitting-better = La talla { $size } le quedaría mejor.
fitting-tape = Una cinta lo aclara: { $zone }.
fitting-smaller = Incluso la talla más pequeña es para medidas mayores. Se muestra la más cercana.
fitting-larger = Incluso la talla más grande es para medidas menores. Se muestra la más cercana.
fitting-dressing = Poniendo la prenda
fitting-refused = No se ha podido poner. Se muestra lo que llevaba antes.
own-picture-kept = Solo usted ve esto. Su imagen no se guarda ni se envía.
own-picture-soon = Su imagen llega en un momento.
own-picture-cannot = La ropa no puede ponerse en la imagen de esta cámara. Elija el maniquí.
own-picture-nobody = El espejo no le ve. Colóquese sobre la marca.
own-picture-back = Retroceda un poco, para que la ropa quepa en la imagen.
own-picture-still = Quédese quieto un momento, de cara al espejo.

# The shopper’s own face on the mannequin
face-heading = Su cara en el maniquí
face-what = Al pulsar se toma una imagen suya, y el maniquí recibe su cara. Póngase derecho y mire al espejo.
face-kept = La imagen y la cara están solo en la memoria de este espejo. No se envían a ninguna parte y se borran cuando usted quita la cara o se va.
face-taking = Poniendo su cara
face-on = El maniquí tiene su cara.
face-no-picture = La cámara no ha dado ninguna imagen. Inténtelo otra vez en un momento.
face-unseen = No se ha visto ninguna cara. Póngase ante el espejo, mírelo e inténtelo otra vez.
face-far = Su cara está demasiado lejos. Acérquese e inténtelo otra vez.
face-turned = Su cara estaba girada. Mire de frente al espejo e inténtelo otra vez.
face-unlike = No se ha podido poner su cara. Aparte de ella el pelo y las manos e inténtelo otra vez.

# The garments
garments-heading = ¿Qué le gustaría probarse?
garments-worn = La lleva puesta
garments-take-off = Toque otra vez para quitarla
garments-instead = Sustituye a: { $others }
garment-strap-dress = Vestido de verano
garment-tee = Camiseta
garment-wide-leg-trousers = Pantalón ancho
garment-mens-blazer = Chaqueta abierta
garment-circle-skirt = Falda de vuelo
garment-slim-trousers = Pantalón estrecho
garment-shirt = Camisa de cuadros
garment-jumper = Jersey de rayas
garment-mens-shirt = Camisa de hombre
garment-mens-trousers = Pantalón de hombre
garment-blazer = Americana
garment-coat = Abrigo
colour-of = Color: { $colour }
colour-own = Tal como se teje
colour-coral = Coral
colour-ivory = Marfil
colour-sky = Azul cielo
colour-moss = Verde musgo
colour-navy = Azul marino
colour-denim = Azul vaquero
colour-white = Blanco
colour-ochre = Ocre
colour-brick = Rojo ladrillo
colour-charcoal = Antracita
colour-sand = Arena

# Fit by zone
zones-heading = Así queda la talla { $size }
zones-held =
    Se sujeta { $level ->
        [neck] en el cuello
        [shoulders] en los hombros
        [bust] en el pecho
        [underbust] bajo el pecho
        [waist] en la cintura
        [crotch] en la entrepierna
       *[feet] en los pies
    }.
zone-chest = Pecho
zone-waist = Cintura
zone-hip = Cadera
fit-ease = { $zone }: { $feel } (+{ $ease } ± { $sigma } cm)
fit-lack = { $zone }: { $feel } (-{ $ease } ± { $sigma } cm)
fit-perhaps = { $fit }, quizá { $feel }
fit-unknown = { $zone }: no se ha visto, así que no se sabe cómo queda
feel-unknown = no se sabe
feel-too-tight = demasiado apretado
feel-tight = apretado
feel-snug = ceñido
feel-right = perfecto
feel-roomy = cómodo
feel-loose = suelto
feel-too-loose = demasiado suelto
legend-loose = suelto
legend-tight = apretado

# Why
zone-heading = { $zone }: ¿por qué?
zone-body = Su contorno de { $zone } mide unos { $body } cm, con un margen de { $sigma } cm.
zone-garment = La prenda mide ahí { $garment } cm.
zone-comfort = En este corte resultan cómodos de { $least } a { $most } cm de holgura.
zone-stretch = En este corte resulta cómodo desde { $least } cm de estiramiento hasta { $most } cm de holgura.
zone-primary = La talla se elige por esta medida.
zone-taped = Usted lo midió con una cinta métrica.
zone-seen = Se ha medido sobre la superficie de su cuerpo.
zone-bones = Solo se han visto su estatura y sus hombros. El contorno se deduce de ellos y es incierto.
zone-guessed = No se ha podido ver. Se usa una media para su estatura.
zone-surer-tape = Una cinta métrica lo deja claro.
zone-surer-again = Medir otra vez sin abrigo ni bolso lo hace más seguro.

# Two sizes
compare-heading = ¿Talla { $left } o { $right }?
compare-zone = { $zone }: la { $left } queda { $left-feel }; la { $right }, { $right-feel }
compare-same = { $zone }: { $feel } en ambas tallas
compare-unknown = { $zone }: no se sabe en ninguna de las dos
compare-draping = Poniendo las dos tallas
compare-refused = No se han podido poner las dos tallas. Lo escrito sigue siendo válido.

# Measures by tape
own-heading = Sus propias medidas
own-why = Lo que midió con una cinta métrica cuenta más que lo que ve el espejo. Elija una medida.
own-forgotten = Cuando se vaya, también se olvidarán.
own-given = Aceptado: { $length }.
own-chest = Pecho
own-waist = Cintura
own-hip = Cadera
own-stature = Estatura
own-underbust = Bajo el pecho
own-leg = Entrepierna
own-arm = Brazo
own-shoulders = Hombros
own-neck = Cuello
own-thigh = Muslo
own-torso = Del cuello a la entrepierna
length-cm = { $length } cm
length-inch = { $length } pulg.
entry-heading = { $measure }: ¿cuánto?
entry-how = Escriba la medida y acéptela.
entry-empty = Escriba primero una medida.
entry-impossible = { $measure }: en las personas va de { $low } a { $high }. Compruebe el número y la unidad.
entry-contradiction = { $measure }: { $given } no concuerda con sus otras medidas. Según ellas serían { $expected } ± { $sigma }. Mida otra vez o quite una.

# The picture
picture-heading = Su imagen
picture-taking = Haciendo la imagen
picture-scan = Escanee el código con su teléfono. Contiene la propia imagen; no se envía nada.
picture-served = Escanee el código con un teléfono conectado a la red de esta tienda. La imagen se ofrece allí sin cifrar; no sale de la tienda.
picture-served-in = Escanee el código con un teléfono conectado a la red { $network }. La imagen se ofrece allí sin cifrar; no sale de la tienda.
picture-until =
    { $minutes ->
        [0] Se borra en menos de un minuto.
        [one] Se borra en { $minutes } minuto.
       *[other] Se borra en { $minutes } minutos.
    }
picture-failed = La imagen no ha salido. Inténtelo otra vez.

# Settings
settings-heading = Idioma y ajustes
settings-stored = El espejo no guarda nada. Solo conoce sus medidas mientras está aquí y las olvida cuando se va.
settings-known =
    { $count ->
        [0] No conoce ninguna medida suya.
        [one] Ahora conoce { $count } medida suya.
       *[other] Ahora conoce { $count } medidas suyas.
    }

# Another person
second-heading = ¿Sigue siendo usted?
second-why = Parece que hay otra persona. Lo que se mostraba está oculto.
second-seconds =
    { $seconds ->
        [one] En { $seconds } segundo se olvidará todo.
       *[other] En { $seconds } segundos se olvidará todo.
    }

# No person is in view
leaving-heading = ¿Sigue ahí?
leaving-seconds =
    { $seconds ->
        [one] En { $seconds } segundo se olvidarán sus datos.
       *[other] En { $seconds } segundos se olvidarán sus datos.
    }

# What can be pressed
do-begin = Empezar
do-measure = Tomar mis medidas
do-measure-again = Medir otra vez
do-seated = En posición sentada
do-garments = Elegir ropa
do-garments-more = Más ropa
do-garments-before = Ropa anterior
do-zones = ¿Cómo queda?
do-compare = Comparar dos tallas
do-smaller = Talla menor
do-larger = Talla mayor
do-size = Talla { $size }
do-turn-left = Girar a la izquierda
do-turn-right = Girar a la derecha
do-fit-map = Mapa de ajuste
do-own-picture = Verme a mí
do-mannequin = Ver el maniquí
do-face = Mi cara
do-face-put-on = Poner mi cara
do-face-again = Intentarlo otra vez
do-face-away = Quitar la cara
do-picture = Hacer una imagen
do-show-picture = Mostrar la imagen
do-delete-picture = Borrar ahora
do-picture-link = Imagen grande
do-picture-own = No en esta red
do-settings = Idioma y ajustes
do-large = Letra grande
do-wear = Llevar la talla { $size }
do-own-measures = Conozco mis medidas
do-delete = Borrar
do-inches = En pulgadas
do-centimetres = En centímetros
do-accept = Aceptar
do-remove = Quitar esta medida
do-go-on = Continuar
do-back = Volver
do-stay = Sigo aquí
do-still-me = Sigo siendo yo
do-begin-anew = Empezar de nuevo
do-leave = He terminado: borrar todo

# Parts of the body that are measured
part-stature = estatura
part-shoulders = hombros
part-chest = pecho
part-waist = cintura
part-hip = cadera
part-legs = largo de pierna
list-and = { $first } y { $last }
list-comma = { $first }, { $last }
