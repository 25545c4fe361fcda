# What a shopper reads, in Turkish.

language = Türkçe

# No person is in view
attract-heading = Denemeden önce nasıl duracağını görün
attract-measure = İşaretin üzerine geçin. Ayna bir saniyede ölçünüzü alır.
attract-fit = Kendinizi kendi bedeninizde görün, nerede dar olduğunu anlayın.
attract-compare = İki bedeni yan yana koyun.
attract-private = Hiçbir şey saklanmaz, hiçbir şey gönderilmez. Ayrıldığınızda unutulursunuz.

# A person has stepped in
guide-heading = İşaretin üzerinde durun
guide-heading-seated = Aynaya dönün
guide-pose = Ayaklar ayrık, kollar gövdeden biraz uzakta.
guide-pose-seated = Dik oturun, kollar gövdeden biraz uzakta.
guide-nearer = Biraz yaklaşın.
guide-farther = Biraz geri gidin.
guide-left = Biraz solunuza geçin.
guide-right = Biraz sağınıza geçin.
guide-alone = Lütfen teker teker.
guide-unseen = Ayna sizi henüz görmüyor. İşaretin üzerine geçin.
camera-lost = Kamera şu anda yanıt vermiyor. Lütfen biraz bekleyin.
camera-covered = Kameranın önünü bir şey kapatıyor. Lütfen önünü açın.
guide-soon = Ölçüm birazdan başlıyor.

# Measuring
measuring-heading = Bir dakika lütfen
measuring-body = Ölçü alınıyor
measuring-dress = Giysiler giydiriliyor
turn-offer = İsterseniz yavaşça bir tam tur dönün. Ölçüleriniz daha kesin olur.
turn-on = Yavaşça dönmeye devam edin.
turn-enough = Teşekkürler, tur tamamlandı.

# What could not be measured
unmeasured-heading = Olmadı
unmeasured-why = Aynanın sizi bir saniye boyunca tek başınıza, baştan dize kadar görmesi gerekir. Bol paltolar ve çantalar vücudu kapatır.
unmeasured-seated = Oturuyor musunuz? “Oturuyorum” seçeneğine dokunun.
partly-heading = Mümkün olduğu kadar ölçüldü
partly-missing = Görülemeyen: { $parts }.
partly-guess = Bu bölgelerde boyunuza göre ortalama bir vücut kullanıldı; sonuç daha az kesindir.
partly-cure = Bel ve kalçadan mezurayla alınan ölçü kesinlik sağlar.

# The fitted body
fitting-size = { $garment }, { $size } beden
fitting-best = Size en çok { $size } beden uyuyor.
fitting-nearest = En yakını { $size } beden, ama her yerde oturmuyor.
fitting-one-size = Tek bedeni var.
fitting-size-unknown = Yapıldığı gibi gösteriliyor: bedeni bilinmiyor.
fitting-sure = %{ $percent } eminiz.
fitting-unsure = Arada kaldık: %{ $percent }.
fitting-better = Size { $size } beden daha iyi olurdu.
fitting-tape = Mezura kesinleştirir: { $zone }.
fitting-smaller = En küçük beden bile daha büyük ölçüler için. En yakınını görüyorsunuz.
fitting-larger = En büyük beden bile daha küçük ölçüler için. En yakınını görüyorsunuz.
fitting-dressing = Giydiriliyor
fitting-refused = Bu giydirilemedi. Önceki giysinizi görüyorsunuz.
own-picture-kept = Bunu yalnızca siz görürsünüz. Görüntünüz saklanmaz ve gönderilmez.
own-picture-soon = Görüntünüz birazdan gelir.
own-picture-cannot = Giysiler bu kameranın görüntüsüne giydirilemiyor. Mankeni seçin.
own-picture-nobody = Ayna sizi görmüyor. İşaretin üstüne geçin.
own-picture-back = Giysilerin görüntüye sığması için biraz geri gidin.
own-picture-still = Aynaya dönük olarak bir an kıpırdamadan durun.

# The shopper’s own face on the mannequin
face-heading = Mankende sizin yüzünüz
face-what = Bastığınızda bir resminiz çekilir ve manken yüzünüzü alır. Dik durun ve aynaya bakın.
face-kept = Resim ve yüz yalnızca bu aynanın belleğindedir. Hiçbir yere gönderilmez; yüzü kaldırdığınızda ya da gittiğinizde silinir.
face-taking = Yüzünüz yerleştiriliyor
face-on = Mankende sizin yüzünüz var.
face-no-picture = Kamera görüntü vermedi. Lütfen birazdan yeniden deneyin.
face-unseen = Hiç yüz görülmedi. Aynanın önünde durun, aynaya bakın ve yeniden deneyin.
face-far = Yüzünüz çok uzakta. Yaklaşın ve yeniden deneyin.
face-turned = Yüzünüz başka yöne dönüktü. Aynaya düz bakın ve yeniden deneyin.
face-unlike = Yüzünüz yerleştirilemedi. Saçınızı ve ellerinizi yüzünüzden çekip yeniden deneyin.

# The garments
garments-heading = Ne denemek istersiniz?
garments-worn = Üzerinizde
garments-take-off = Çıkarmak için yeniden dokunun
garments-instead = Şunun yerine: { $others }
garment-strap-dress = Yazlık elbise
garment-tee = Tişört
garment-wide-leg-trousers = Bol pantolon
garment-mens-blazer = Önü açık ceket
garment-circle-skirt = Kloş etek
garment-slim-trousers = Dar pantolon
garment-shirt = Kareli gömlek
garment-jumper = Çizgili kazak
garment-mens-shirt = Erkek gömleği
garment-mens-trousers = Erkek pantolonu
garment-blazer = Blazer
garment-coat = Palto
colour-of = Renk: { $colour }
colour-own = Kumaşın kendi rengi
colour-coral = Mercan
colour-ivory = Fildişi
colour-sky = Gök mavisi
colour-moss = Yosun yeşili
colour-navy = Lacivert
colour-denim = Kot mavisi
colour-white = Beyaz
colour-ochre = Hardal
colour-brick = Kiremit
colour-charcoal = Antrasit
colour-sand = Kum rengi

# Fit by zone
zones-heading = { $size } beden nasıl oturuyor
zones-held =
    Giysi { $level ->
        [neck] boyunda
        [shoulders] omuzlarda
        [bust] göğüste
        [underbust] göğüs altında
        [waist] belde
        [crotch] ağ kısmında
       *[feet] ayaklarda
    } durur.
zone-chest = Göğüs
zone-waist = Bel
zone-hip = Kalça
fit-ease = { $zone }: { $feel } (+{ $ease } ± { $sigma } cm)
fit-lack = { $zone }: { $feel } (-{ $ease } ± { $sigma } cm)
fit-perhaps = { $fit }, belki { $feel }
fit-unknown = { $zone }: görülmedi, nasıl oturduğu bilinmiyor
feel-unknown = bilinmiyor
feel-too-tight = çok fazla dar
feel-tight = dar
feel-snug = vücuda oturan
feel-right = tam kararında
feel-roomy = rahat
feel-loose = bol
feel-too-loose = çok fazla bol
legend-loose = bol
legend-tight = dar

# Why
zone-heading = { $zone }: neden?
zone-body = Ölçünüz: { $zone } çevresi yaklaşık { $body } cm, artı eksi { $sigma } cm.
zone-garment = Giysi orada { $garment } cm.
zone-comfort = Bu kesimde { $least } ile { $most } cm arası bolluk rahattır.
zone-stretch = Bu kesimde { $least } cm esneme ile { $most } cm bolluk arası rahattır.
zone-primary = Beden bu ölçüye göre seçilir.
zone-taped = Bunu mezurayla kendiniz ölçtünüz.
zone-seen = Vücudunuzun yüzeyinden ölçüldü.
zone-bones = Yalnızca boyunuz ve omuzlarınız görüldü. Çevre bunlardan hesaplandı ve kesin değildir.
zone-guessed = Görülemedi. Boyunuza göre bir ortalama kullanıldı.
zone-surer-tape = Mezura kesinlik sağlar.
zone-surer-again = Palto ve çanta olmadan yeniden ölçmek daha kesin sonuç verir.

# Two sizes
compare-heading = { $left } beden mi, { $right } beden mi?
compare-zone = { $zone }: { $left } { $left-feel }, { $right } { $right-feel }
compare-same = { $zone }: ikisi de { $feel }
compare-unknown = { $zone }: iki beden için de bilinmiyor
compare-draping = İki beden giydiriliyor
compare-refused = İki beden giydirilemedi. Yazılanlar yine de geçerli.

# Measures by tape
own-heading = Kendi ölçüleriniz
own-why = Mezurayla ölçtükleriniz, aynanın gördüğünden önce gelir. Bir ölçü seçin.
own-forgotten = Gittiğinizde bunlar da unutulur.
own-given = Kabul edildi: { $length }.
own-chest = Göğüs
own-waist = Bel
own-hip = Kalça
own-stature = Boy
own-underbust = Göğüs altı
own-leg = İç bacak
own-arm = Kol
own-shoulders = Omuz
own-neck = Boyun
own-thigh = Uyluk
own-torso = Boyundan kasığa
length-cm = { $length } cm
length-inch = { $length } inç
entry-heading = { $measure }: ne kadar?
entry-how = Uzunluğu yazın ve kabul edin.
entry-empty = Önce bir uzunluk yazın.
entry-impossible = { $measure }: insanlarda { $low } ile { $high } arasındadır. Lütfen sayıyı ve birimi kontrol edin.
entry-contradiction = { $measure }: { $given } öbür ölçülerinizle uyuşmuyor. Onlara göre { $expected } ± { $sigma } olmalı. Yeniden ölçün ya da birini kaldırın.

# The picture
picture-heading = Resminiz
picture-taking = Resim çekiliyor
picture-scan = Kodu telefonunuzla okutun. Resim kodun içindedir; hiçbir şey gönderilmez.
picture-served = Telefonunuz bu mağazanın ağındayken kodu okutun. Resim orada şifresiz sunulur; mağazadan çıkmaz.
picture-served-in = Telefonunuz { $network } ağındayken kodu okutun. Resim orada şifresiz sunulur; mağazadan çıkmaz.
picture-until =
    { $minutes ->
        [0] Bir dakikadan kısa sürede silinir.
        [one] { $minutes } dakika içinde silinir.
       *[other] { $minutes } dakika içinde silinir.
    }
picture-failed = Resim çekilemedi. Lütfen yeniden deneyin.

# Settings
settings-heading = Dil ve ayarlar
settings-stored = Ayna hiçbir şey saklamaz. Ölçülerinizi yalnızca siz buradayken bilir, ayrıldığınızda unutur.
settings-known =
    { $count ->
        [0] Şu anda hiçbir ölçünüzü bilmiyor.
        [one] Şu anda { $count } ölçünüzü biliyor.
       *[other] Şu anda { $count } ölçünüzü biliyor.
    }

# Another person
second-heading = Hâlâ siz misiniz?
second-why = Burada başka biri duruyor gibi. Gösterilenler gizlendi.
second-seconds =
    { $seconds ->
        [one] { $seconds } saniye sonra her şey unutulacak.
       *[other] { $seconds } saniye sonra her şey unutulacak.
    }

# No person is in view
leaving-heading = Hâlâ burada mısınız?
leaving-seconds =
    { $seconds ->
        [one] { $seconds } saniye sonra unutulacaksınız.
       *[other] { $seconds } saniye sonra unutulacaksınız.
    }

# What can be pressed
do-begin = Başla
do-measure = Ölçümü al
do-measure-again = Yeniden ölç
do-seated = Oturuyorum
do-garments = Giysi seç
do-garments-more = Diğer giysiler
do-garments-before = Önceki giysiler
do-zones = Nasıl oturuyor?
do-compare = İki bedeni karşılaştır
do-smaller = Küçük beden
do-larger = Büyük beden
do-size = { $size } beden
do-turn-left = Sola döndür
do-turn-right = Sağa döndür
do-fit-map = Uyum haritası
do-own-picture = Kendimi gör
do-mannequin = Mankeni gör
do-face = Yüzüm
do-face-put-on = Yüzümü yerleştir
do-face-again = Yeniden dene
do-face-away = Yüzü kaldır
do-picture = Resim çek
do-show-picture = Resmi göster
do-delete-picture = Şimdi sil
do-picture-link = Büyük resim
do-picture-own = Bu ağda değil
do-settings = Dil ve ayarlar
do-large = Büyük yazı
do-wear = { $size } bedeni giy
do-own-measures = Ölçülerimi biliyorum
do-delete = Sil
do-inches = İnç olarak
do-centimetres = Santimetre olarak
do-accept = Kabul et
do-remove = Bu ölçüyü kaldır
do-go-on = Devam
do-back = Geri
do-stay = Buradayım
do-still-me = Hâlâ benim
do-begin-anew = Baştan başla
do-leave = Bitti: beni unut

# Parts of the body that are measured
part-stature = boy
part-shoulders = omuz genişliği
part-chest = göğüs
part-waist = bel
part-hip = kalça
part-legs = bacak boyu
list-and = { $first } ve { $last }
list-comma = { $first }, { $last }
